#include "run/channel_ranks.h"

#include <algorithm>

#include "base/digest.h"
#include "base/error.h"
#include "base/one_line.h"
#include "print.h"
#include "record/playback.h"

namespace vesper::drive {
namespace {

using apps::Bytes, apps::PacketReader, apps::PacketWriter, apps::Ranks;

constexpr uint64_t kFramesToKnow = 3;
constexpr double kTimesLonger = 5;  // than any before

enum class News : uint8_t { Event, Message, Rewind, Frame, End };

Ranks::Stream stream_of(ChannelLink::Kind kind) {
    switch (kind) {
        case ChannelLink::Kind::Nodes:
            return Ranks::Stream::Nodes;
        case ChannelLink::Kind::Light:
            return Ranks::Stream::Light;
        case ChannelLink::Kind::Statistics:
            break;
    }
    return Ranks::Stream::Statistics;
}

void write_event(PacketWriter& news, const DriveEvent& event) {
    news.value(News::Event);
    news.value(event.kind), news.value(event.input);
    news.value(event.shown.has_value()), news.value(event.shown.value_or(0));
    news.list(event.name), news.list(event.value);
}

DriveEvent read_event(PacketReader& news) {
    DriveEvent event{.pose = {}, .shown = {}, .name = {}, .value = {}};
    news.value(event.kind), news.value(event.input);
    const bool has_moment = news.value<bool>();
    const auto moment = news.value<double>();
    if (has_moment) event.shown = moment;
    event.name = news.text(), event.value = news.text();
    return event;
}

Digest::Value digest_of(const shared::EyeState& eye) {
    Digest digest;
    digest.add_value(eye);
    return digest.value();
}

}  // namespace

std::vector<int> ranks_of(const Channels& channels, int ranks) {
    const size_t count = channels.screens.size();
    if (ranks == 1) return std::vector<int>(count, 0);
    std::vector<int> found;
    for (const ScreenChannel& c : channels.screens)
        if (c.rank) found.push_back(*c.rank);
    if (found.empty()) {
        const auto viewers = size_t(ranks - 1);
        if (viewers > count)
            throw Error("there are " + std::to_string(ranks) + " ranks, one that drives and " +
                        std::to_string(viewers) + " for " + std::to_string(count) +
                        " channels: no rank may be without a channel");
        for (size_t viewer = 0; viewer < viewers; ++viewer)
            found.resize((viewer + 1) * count / viewers, int(viewer) + 1);
        return found;
    }
    for (const ScreenChannel& c : channels.screens) {
        if (!c.rank) throw Error("channel " + one_line(c.name) + " has no rank, and others have");
        if (*c.rank >= ranks)
            throw Error("channel " + one_line(c.name) + " is of rank " + std::to_string(*c.rank) +
                        ", and there are ranks 0 to " + std::to_string(ranks - 1));
    }
    for (int rank = 1; rank < ranks; ++rank)
        if (std::ranges::find(found, rank) == found.end())
            throw Error("rank " + std::to_string(rank) + " has no channel");
    return found;
}

std::string columns_of(const ChannelRanks::Meeting& meeting) {
    return apps::format(",%.0f,%d", meeting.skew * 1e6, meeting.last);
}

ChannelRanks::ChannelRanks(Ranks& ranks, const Channels& channels)
    : ranks_(ranks), rank_of_(ranks_of(channels, ranks.size())), gaze_(channels.gaze) {
    std::vector<std::string> roles(size_t(ranks.size()));
    for (size_t i = 0; i < rank_of_.size(); ++i) {
        std::string& role = roles[size_t(rank_of_[i])];
        role += (role.empty() ? "" : " and ") + one_line(channels.screens[i].name, 40);
    }
    for (int rank = 0; rank < ranks.size(); ++rank) ranks.set_role(rank, roles[size_t(rank)]);
}

std::vector<std::vector<size_t>> ChannelRanks::shares(size_t channels) const {
    std::vector<std::vector<size_t>> by_rank(size_t(ranks_.size()));
    for (size_t i = 0; i < channels; ++i) by_rank[size_t(rank_of_[i])].push_back(i);
    return by_rank;
}

std::vector<size_t> ChannelRanks::own(size_t channels) const { return shares(channels)[size_t(ranks_.rank())]; }

// What goes to all does so by the first rank, which has it in the end: of each rank a message, and one to each. What
// each is told, which is more, goes straight there.
void ChannelRanks::say(Kind kind, Bytes bytes) {
    if (is_first())
        ChannelLink::say(kind, std::move(bytes));
    else
        ranks_.send(0, stream_of(kind), std::move(bytes));
}

void ChannelRanks::say_to_each(Kind kind, std::vector<Bytes> bytes) {
    for (int rank = 0; rank < ranks_.size(); ++rank)
        if (rank == ranks_.rank())
            ChannelLink::say(kind, std::move(bytes[size_t(rank)]));
        else
            ranks_.send(rank, stream_of(kind), std::move(bytes[size_t(rank)]));
}

std::vector<Bytes> ChannelRanks::hear(Kind kind) {
    const bool each = kind == Kind::Light;
    if (!each && !is_first()) return apps::parted(ranks_.receive(0, stream_of(kind)));
    std::vector<Bytes> all;
    for (int rank = 0; rank < ranks_.size(); ++rank)
        all.push_back(rank == ranks_.rank() ? std::move(ChannelLink::hear(kind).front())
                                            : ranks_.receive(rank, stream_of(kind)));
    if (!each) ranks_.broadcast(stream_of(kind), apps::joined(all));
    return all;
}

void ChannelRanks::lead(Session& session) {
    session.on_event = [this](const DriveEvent* event) {
        unusual_ |= !event || event->kind == DriveEvent::Kind::Set || event->kind == DriveEvent::Kind::Restart;
        if (!event)
            news_.value(News::Rewind);
        else if (event->kind != DriveEvent::Kind::Frame)
            write_event(news_, *event);
    };
    session.on_message = [this](const osi::Message& message) {
        news_.value(News::Message);
        news_.list(osi::bytes_of(message));
    };
}

// The next frame that the session renders is one of all.
void ChannelRanks::begin_frame(const Wanted& wanted) {
    wanted_ = wanted;
    frame_watch_ = {};
    // A rank whose main thread hangs has to be told from one that is slow.
    ranks_.set_patience(unusual_ || usual_frames_ < kFramesToKnow ? 0 : Ranks::kSilence + kTimesLonger * longest_);
    news_.value(News::Frame), news_.value(wanted);
    ranks_.broadcast(Ranks::Stream::Events, std::exchange(news_, {}).take());
}

void ChannelRanks::end_drive() {
    ranks_.set_patience(0);
    news_.value(News::End);
    ranks_.broadcast(Ranks::Stream::Events, std::exchange(news_, {}).take());
}

// Does what the first rank's session did, up to a frame. Nothing: the drive is over.
std::optional<ChannelRanks::Wanted> ChannelRanks::await_frame(Session& session,
                                                              const std::function<void()>& meanwhile) {
    const Bytes bytes = ranks_.receive(0, Ranks::Stream::Events, meanwhile);
    for (PacketReader news(bytes);;) {
        switch (news.value<News>()) {
            case News::Event:
                perform(session, read_event(news));
                break;
            case News::Message: {
                const std::vector<uint8_t> message = news.list<uint8_t>();
                session.hear(osi::parse_message(message));
                break;
            }
            case News::Rewind:
                session.rewind();
                break;
            case News::Frame:
                return news.value<Wanted>();
            case News::End:
                return std::nullopt;
        }
    }
}

void ChannelRanks::report(const Wanted& wanted, const ChannelMosaic& wall, const std::string& row) {
    const bool tells = (wanted.row && has(gaze_)) || wanted.display || wanted.scene;
    if (!tells) return;
    PacketWriter packet;
    packet.list(row);
    for (size_t i = 0; i < rank_of_.size(); ++i) {
        if (!has(i) || !(wanted.display || wanted.scene)) continue;
        const render::Frame& channel = wall.channels[i];
        packet.value(uint64_t{i});
        packet.value(channel.extent), packet.value(channel.lamps);
        packet.list(wanted.display ? channel.display : std::vector<uint8_t>());
        packet.list(wanted.scene ? channel.scene : std::vector<float>());
    }
    ranks_.send(0, Ranks::Stream::Records, packet.take());
}

// What was wanted of other ranks, and the row of the log, empty where this rank has made it.
std::string ChannelRanks::collect(ChannelMosaic& wall) {
    std::string row;
    const bool pictures = wanted_.display || wanted_.scene;
    for (int other = 1; other < ranks_.size(); ++other) {
        if (!pictures && !(wanted_.row && rank_of_[gaze_] == other)) continue;
        const Bytes bytes = ranks_.receive(other, Ranks::Stream::Records);
        PacketReader packet(bytes);
        row += packet.text();
        while (!packet.at_end()) {
            render::Frame& channel = wall.channels.at(packet.value<uint64_t>());
            packet.value(channel.extent), packet.value(channel.lamps);
            channel.display = packet.list<uint8_t>(), channel.scene = packet.list<float>();
        }
    }
    if (pictures) put_together(wall, wanted_.scene);
    return row;
}

// Before a frame is shown: waits until all ranks can show theirs.
ChannelRanks::Meeting ChannelRanks::meet(const shared::EyeState& eye) {
    const Digest::Value mine = digest_of(eye);
    const Stopwatch watch;
    ++frames_;
    if (!is_first()) {
        PacketWriter packet;
        packet.value(mine), packet.value(waited_);
        ranks_.send(0, Ranks::Stream::Ready, packet.take());
        ranks_.receive(0, Ranks::Stream::Ready);
        waited_ = watch.milliseconds() / 1e3;
        return {};
    }
    // Clocks of machines differ: each tells how long it waited.
    std::vector<double> waited(size_t(ranks_.size()), waited_);
    for (int other = 1; other < ranks_.size(); ++other) {
        const Bytes ready = ranks_.receive(other, Ranks::Stream::Ready);
        PacketReader packet(ready);
        if (packet.value<Digest::Value>() != mine)
            throw Error(ranks_.name(other) + ": its eye is not that of " + ranks_.name(0) + " in frame " +
                        std::to_string(frames_));
        packet.value(waited[size_t(other)]);
    }
    if (!std::exchange(unusual_, false))
        ++usual_frames_, longest_ = std::max(longest_, frame_watch_.milliseconds() / 1e3);
    waited_ = watch.milliseconds() / 1e3;
    ranks_.broadcast(Ranks::Stream::Ready, {});
    const auto sooner = [&](int a, int b) { return waited[size_t(a)] < waited[size_t(b)]; };
    const auto [last, first] = std::minmax_element(rank_of_.begin(), rank_of_.end(), sooner);
    return {waited[size_t(*first)] - waited[size_t(*last)], *last};
}

ChannelRanks::LedFrame ChannelRanks::render(Session& session, const Channels& channels, const render::Outputs& outputs,
                                            const render::Outputs& film, DriveRows* rows) {
    begin_frame({.display = film.display, .scene = film.scene, .row = rows != nullptr});
    LedFrame frame{.wall = session.render(channels, outputs), .meeting = {}, .row = {}};
    frame.meeting = meet(frame.wall.shown.eye);
    if (rows && has(gaze_)) frame.row = row_of(*rows, session, channels, frame.wall);
    frame.row += collect(frame.wall);
    return frame;
}

void ChannelRanks::follow(Session& session, const Channels& channels, DriveRows& rows, const Watching& watching) {
    session.on_contact = [&](const traffic::Contact& contact) { rows.add(contact); };
    while (const auto wanted = await_frame(session, watching.meanwhile)) {
        const bool ldr = session.settings().render().tone_operator == render::Operator::Ldr;
        const bool measures = wanted->row && has(gaze_) && !ldr;
        ChannelMosaic wall =
            session.render(channels, {.display = wanted->display || watching.show, .scene = wanted->scene || measures});
        meet(wall.shown.eye);
        if (watching.show) watching.show(wall);
        report(*wanted, wall, wanted->row && has(gaze_) ? row_of(rows, session, channels, wall) : "");
    }
    session.leave_channels();
}

}  // namespace vesper::drive
