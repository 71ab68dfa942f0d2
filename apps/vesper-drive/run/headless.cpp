// Drives without a window: to a film, to pictures, to a log. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "arguments/arguments.h"
#include "arguments/cache_arguments.h"
#include "arguments/obstacle_arguments.h"
#include "arguments/picture_arguments.h"
#include "arguments/tone_arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "gathered_light.h"
#include "io/file_gate.h"
#include "io/image_file.h"
#include "numbered_files.h"
#include "own_data.h"
#include "print.h"
#include "progress.h"
#include "ranks/frame_relay.h"
#include "record/drive_log.h"
#include "record/hatching.h"
#include "record/playback.h"
#include "run/channel_ranks.h"
#include "run/drive.h"
#include "scaled_picture.h"
#include "session/drive_file.h"
#include "session/message_feed.h"
#include "session/session.h"
#include "video.h"

namespace vesper::drive {
namespace {

constexpr double kUsualRate = 30;  // frames a second

// Steps of time with frames at an even rate among them. `waits`: nothing is known before the first step.
DriveEvents evenly(const DriveEvents& events, double time_step, double fps, bool waits) {
    const DriveEvent frame{.kind = DriveEvent::Kind::Frame, .pose = {}, .shown = {}, .name = {}, .value = {}};
    DriveEvents made;
    uint64_t steps = 0, frames = 0;
    // The first frame is that before the first step, after what was set until then.
    const auto begin = [&] {
        if (frames == 0) made.push_back(frame), frames = 1;
    };
    for (const DriveEvent& event : events) {
        if (event.kind == DriveEvent::Kind::Frame) continue;
        if (event.kind == DriveEvent::Kind::Step && !waits) begin();
        made.push_back(event);
        // The first step that has reached the frame's time; at most one frame a step.
        if (event.kind != DriveEvent::Kind::Step || double(++steps) * time_step * fps < double(frames) - 1e-6) continue;
        made.push_back(frame);
        frames = std::max(frames + 1, uint64_t(double(steps) * time_step * fps + 1e-6) + 1);
    }
    begin();
    return made;
}

// Frames a second that a film of recorded frames plays with, and whether they were recorded at that rate.
std::pair<double, bool> rate_of(const DriveEvents& events, double time_step) {
    std::vector<unsigned> strides;
    unsigned steps = 0;
    bool first = true, twice = false;  // before the first step; at one moment
    for (const DriveEvent& event : events) {
        if (event.kind == DriveEvent::Kind::Step) ++steps;
        if (event.kind != DriveEvent::Kind::Frame) continue;
        if (steps > 0)
            strides.push_back(std::exchange(steps, 0));
        else
            twice |= !first;
        first = false;
    }
    if (strides.empty()) return {kUsualRate, true};
    const auto [least, most] = std::minmax_element(strides.begin(), strides.end());
    const bool even = *least == *most && !twice;
    std::nth_element(strides.begin(), strides.begin() + strides.size() / 2, strides.end());
    return {1 / (strides[strides.size() / 2] * time_step), even};
}

/// Where frames go.
class Outlet {
public:
    /// `scale`: of each side that is rendered; `meets`: ranks do so to show a frame.
    Outlet(const DriveArguments& a, VkExtent2D extent, double scale, bool meets)
        : arguments_(a),
          extent_(extent),
          scale_(scale),
          scaled_(extent, scale),
          probes_(probes_of(a.probes)),
          meets_(meets) {
        if (!a.video.empty()) {
            film_ = a.video.ends_with(".mp4");
            exr_ = a.video.ends_with(".exr");
            if (!film_ && !exr_ && !a.video.ends_with(".png"))
                throw Error("--video " + one_line(a.video) + ": .mp4, .png or .exr is expected");
            if (!film_) names_ = apps::numbered_name("--video", a.video);
            if (!film_ && !names_)
                throw Error("--video " + one_line(a.video) +
                            ": one file a frame needs a number in the name, such as %05d");
            if (apps::Ranks::own_number() == 0) io::announce_write("--video", film_ ? a.video : names_->at(0));
        }
    }
    bool wanted() const { return film_ || names_ || !arguments_.log.empty() || !arguments_.obstacles.empty(); }
    /// Throws Error if pictures with these settings cannot go there, in a film that began with those it was asked of
    /// first.
    void check(const DriveSettings& settings) {
        if (!first_) {
            first_ = settings.render().display;
            for (const auto& [name, text] : of_codes(settings))
                comment_ += (comment_.empty() ? "" : " ") + name + "=" + text;
        }
        const vision::Display &display = settings.render().display, &before = *first_;
        if (exr_ && settings.render().tone_operator == render::Operator::Ldr)
            throw Error("--video " + one_line(arguments_.video) + ": the ldr operator has no luminances to write");
        if (film_ &&
            (display.bits != before.bits || display.eotf != before.eotf || display.primaries != before.primaries))
            throw Error("--video " + one_line(arguments_.video) +
                        ": a film has codes of one kind, and those of this display are others");
    }
    /// Once everything is read, and before anything is written: no name of so many frames may be another file's.
    void open(size_t frames, const std::vector<scene::Obstacle>& obstacles) {
        if (names_) announce_numbered(frames);
        if (logs()) log_.emplace(arguments_.log, probes_, meets_ ? kMeetingColumns : apps::obstacle_columns(obstacles));
    }
    /// On other ranks than the first, in its place.
    bool logs() const { return !arguments_.log.empty(); }
    DriveRows& rows() { return log_ ? log_->rows() : rows_; }
    bool wants_scene() const { return exr_; }
    render::Outputs outputs(const Session& session) const {
        const bool ldr = session.settings().render().tone_operator == render::Operator::Ldr;
        return {.display = film_ || (names_ && !exr_),
                .scene = exr_ || (logs() && !ldr),
                .projection = scaled_.enlargement()};
    }
    const apps::ScaledPicture& scaled() const { return scaled_; }
    /// Writes the files of a frame. Returns what is to be appended to others: of the picture, and of the row.
    apps::Bytes take(unsigned index, const Session& session, const render::ToneMapped& shown, uint32_t lamps,
                     const std::string& row) {
        const vision::Display& display = session.settings().render().display;
        if (names_ && !exr_) apps::write_codes(names_->at(index), shown, display, of_codes(session.settings()));
        if (names_ && exr_)
            io::write_exr(names_->at(index), shown.extent.width, shown.extent.height, shown.scene,
                          header(session, shown, lamps));
        apps::PacketWriter packet;
        packet.list(film_ ? std::span(shown.display) : std::span<const uint8_t>());
        packet.list(row);
        return packet.take();
    }
    void append(const apps::Bytes& taken, double fps) {
        apps::PacketReader packet(taken);
        const std::vector<uint8_t> codes = packet.list<uint8_t>();
        if (film_ && !video_)
            video_ =
                std::make_unique<apps::Video>(arguments_.video, extent_.width, extent_.height, fps, *first_, comment_);
        if (video_) video_->add(codes);
        if (log_) log_->append(packet.text());
    }
    void finish() {
        if (video_) video_->finish();
        if (log_) log_->complete();
    }

private:
    // Names are many, so those are looked at that something has: a file of that folder, or another output.
    void announce_numbered(size_t frames) const {
        std::set<unsigned> numbers;
        if (names_->after.find('/') != names_->after.npos) {  // a folder for each
            for (size_t i = 1; i < frames; ++i) numbers.insert(unsigned(i));
        } else {
            for (const auto& [option, other] : growing_outputs(arguments_))
                if (const auto number = apps::number_in(*names_, other)) numbers.insert(*number);
            for (const apps::NumberedFile& there : apps::existing_files(*names_)) numbers.insert(there.number);
        }
        for (const unsigned number : numbers)
            if (number > 0 && number < frames) io::announce_write("--video", names_->at(number));
    }
    render::RenderSettings scaled(const DriveSettings& settings) const {
        render::RenderSettings made = settings.render();
        made.scale = scale_;
        return made;
    }
    io::Header of_codes(const DriveSettings& settings) const {
        return apps::describe_codes(settings.quality(), scaled(settings));
    }
    io::Header header(const Session& session, const render::ToneMapped& frame, uint32_t lamps) const {
        const DriveSettings& settings = session.settings();
        std::string options;  // settings other than the defaults
        for (const auto& [name, value] : settings.values())
            options += (options.empty() ? "" : " ") + apps::in_shell("--" + name) + " " + apps::in_shell(value);
        const std::string scene = session.scenery().scene().name, own = apps::own_data_name(scene);
        io::Header made{{"vesper:version", VESPER_VERSION},
                        {"vesper:scene", own.empty() ? scene : own},
                        {"vesper:unit", "cd/m^2, linear Rec. 709 RGB"},
                        {"vesper:options", options},
                        {"vesper:seconds", apps::digits(session.world().seconds())},
                        {"vesper:lights", std::to_string(lamps)}};
        for (const io::Header& part :
             {apps::describe_settings(apps::recorded_settings(settings.quality(), scaled(settings))),
              apps::describe_tone(settings.render(), frame)})
            made.insert(made.end(), part.begin(), part.end());
        return made;
    }

    const DriveArguments& arguments_;
    VkExtent2D extent_;
    double scale_;
    apps::ScaledPicture scaled_;
    std::vector<LogProbe> probes_;
    bool film_ = false, exr_ = false;
    std::optional<vision::Display> first_;
    std::string comment_;  // of a film
    std::optional<apps::NumberedName> names_;
    std::unique_ptr<apps::Video> video_;
    std::optional<DriveLog> log_;
    const bool meets_;
    DriveRows rows_{probes_};
};

// One picture of all channels; the log is of the one that is looked at.
void take_wall(Outlet& outlet, unsigned index, Session& session, const Channels& channels, ChannelRanks* ranks,
               double fps) {
    const render::Outputs outputs = outlet.outputs(session);
    DriveRows* rows = outlet.logs() ? &outlet.rows() : nullptr;
    ChannelMosaic wall;
    std::string row;
    if (ranks) {
        ChannelRanks::LedFrame led = ranks->render(session, channels, outputs,
                                                   {.display = outputs.display, .scene = outlet.wants_scene()}, rows);
        wall = std::move(led.wall), row = led.row + columns_of(led.meeting);
    } else {
        wall = session.render(channels, outputs);
        if (rows) row = row_of(*rows, session, channels, wall);
    }
    outlet.append(outlet.take(index, session, wall.shown, wall.channels[channels.gaze].lamps, row), fps);
}

VkExtent2D extent_of(const Channels& channels) {
    VkExtent2D extent{0, 0};
    for (const ScreenChannel& c : channels.screens)
        extent = {extent.width + c.extent.width, std::max(extent.height, c.extent.height)};
    return extent;
}

// A drive along with a simulator that sends: each step waits until its messages are there.
class Live {
public:
    Live(const DriveArguments& a, Session& session, Playback& playback)
        : feed_(osi::parse_address(a.osi_udp), a.osi_delay), first_(a.osi_wait) {
        apps::print_note("listening at " + feed_.place());
        if (!feed_.wait_for(session, 0, first_))
            throw Error("--osi-udp " + one_line(a.osi_udp) +
                        apps::format(": no message came in %g s (--osi-wait); of what came: ", first_) +
                        feed_.report());
        playback.live_moment = [this, &session] {
            moment_ += session.options().time_step;
            if (!feed_.wait_for(session, moment_, first_)) over_ = true;
            return std::optional(moment_);
        };
    }
    bool is_over() const { return over_; }
    void finish(const Session& session) {
        apps::print_note(feed_.report() + (over_ ? "; the sender is silent, and the drive is over" : ""));
        if (session.raises_objects()) apps::print_note(kRaised);
    }

private:
    MessageFeed feed_;
    double first_;  // s
    double moment_ = 0;
    bool over_ = false;
};

}  // namespace

void run_headless(const DriveArguments& a) {
    std::optional<Channels> channels;
    if (!a.channels.empty()) channels = read_channels(a.channels);
    std::optional<ChannelRanks> ranks;
    if (channels && apps::Ranks::several()) ranks.emplace(apps::Ranks::all(), *channels);
    const bool first = apps::Ranks::own_number() == 0;
    if (apps::Ranks::several() && !channels && a.messages.live)
        throw Error("--osi-udp: what is sent is shown by several ranks with --channels only");
    Drive drive;
    const bool replays = !a.replay.empty();
    if (replays) drive = read_drive(a.replay);
    const VkExtent2D extent = channels                            ? extent_of(*channels)
                              : drive.start.size && !a.size_given ? VkExtent2D{drive.start.size->x, drive.start.size->y}
                                                                  : apps::parse_size(a.size);
    const DriveStart options = start_of(a, drive.start);
    const double scale = channels        ? 1
                         : a.scale_given ? a.scale
                                         : DriveSettings(options.settings, options.quality).render().scale;
    Outlet outlet(a, extent, scale, ranks.has_value());
    if (!drive.complete) apps::print_note(one_line(a.replay) + " breaks off; what there is of it is driven");
    const DriveEvent step{.kind = DriveEvent::Kind::Step,
                          .input = {.autopilot = a.autopilot},
                          .pose = {},
                          .shown = {},
                          .name = {},
                          .value = {}};
    for (long left = replays ? 0 : std::lround(a.seconds / options.time_step); left > 0; --left)
        drive.events.push_back(step);
    const bool own_frames = drive.events.frames() > 0 && a.fps == 0;
    if (outlet.wanted() && !own_frames)
        drive.events = evenly(drive.events, options.time_step, a.fps > 0 ? a.fps : kUsualRate, options.messages.live);
    const double most = 1 / options.time_step;
    if (a.fps > most * 1.001)
        throw Error(
            apps::format("--fps %g: the world goes on in steps of %.6g s, so there are at most %.6g frames a second",
                         a.fps, options.time_step, most));
    const auto [fps, even] = own_frames ? rate_of(drive.events, options.time_step)
                                        : std::pair(std::min(a.fps > 0 ? a.fps : kUsualRate, most), true);
    if (!even && a.video.ends_with(".mp4"))
        apps::print_note(apps::format(
            "frames were not recorded at an even rate: the film shows them at %.4g a second, and not in real "
            "time (--fps %.4g takes frames at an even rate)",
            fps, std::min(kUsualRate, most)));
    Scenery scenery(options.scene, options.messages);
    check_settings(
        drive, a.settings, [&](const DriveSettings& settings) { scenery.check(settings); },
        [&](const DriveSettings& settings) { outlet.check(settings); });
    if (!outlet.wanted() && a.record.empty() && a.osi_out.empty())
        throw Error("nothing to do: give --video, --log, --obstacle, --record or --osi-out");
    std::vector<scene::Obstacle> obstacles =
        apps::obstacles_of(scenery.scene(), a.obstacles, DriveSettings(options.settings).render());
    Detections detections(obstacles, a.visible_from);
    gpu::Device device({.select = a.device});
    Session session(device, options, std::move(scenery));
    session.watch(std::move(obstacles)), session.find_obstacle_pixels(a.hatches);
    if (channels) check_displays(*channels, session.settings().render().display);
    if (channels) session.share_channels(ranks ? &*ranks : nullptr, a.latency);
    apps::Ranks::all().agree_on_start();
    const std::shared_ptr<Cache> cache = apps::cache_of(a.cache);
    session.keep_maps(cache);
    const bool renders = outlet.wanted() && (!ranks || !ranks->own(channels->screens.size()).empty());
    apps::Ranks::all().in_turns([&] {
        if (renders) session.gather_light(cache.get());
    });
    session.on_maps = [](const render::ShadowReport& report) { apps::print_cache_note(report.note); };
    session.on_contact = [&](const traffic::Contact& contact) { outlet.rows().add(contact); };
    if (ranks && !first) return ranks->follow(session, *channels, outlet.rows(), {});
    if (ranks) ranks->lead(session);
    Playback playback(std::move(drive.events), a.settings);
    std::optional<Live> live;
    if (a.messages.live) live.emplace(a, session, playback);
    if (first) outlet.open(playback.frames(), session.obstacles());
    apps::print_notes(session.scenery().notes());
    if (!channels) outlet.scaled().print_note();
    if (first && !a.osi_out.empty()) session.write_trace(a.osi_out);
    if (first && !a.record.empty())
        session.record(a.record, outlet.wanted() && !channels ? std::optional(glm::uvec2(extent.width, extent.height))
                                                              : std::nullopt);
    apps::Progress progress(replays ? "replaying" : "driving", unsigned(std::max<size_t>(1, playback.frames())));
    apps::FrameRelay relay(device, apps::Ranks::all(), unsigned(playback.frames()));
    unsigned index = 0;
    session.frame_maker = [&](auto& renderer, auto& settings, auto& view, auto& moment, float seconds, auto& outputs,
                              bool fresh) {
        return relay.render(renderer, settings, view, moment, seconds, outputs, index, {.fresh = fresh});
    };
    const auto take = [&, rate = fps](unsigned, const apps::Bytes& taken) {
        outlet.append(taken, rate);
        progress.step();
    };
    while (const auto kind = playback.next(session)) {
        if (live && live->is_over()) break;
        if (kind != DriveEvent::Kind::Frame || !outlet.wanted()) continue;
        if (channels) {
            take_wall(outlet, index, session, *channels, ranks ? &*ranks : nullptr, fps);
            progress.step();
        } else if (relay.has(index)) {
            const gpu_scene::View view = outlet.scaled().rendered(session.view(extent));
            render::Frame frame = session.render(view, outlet.outputs(session));
            const render::RenderSettings& settings = session.settings().render();
            std::string row = outlet.logs() ? outlet.rows().next(session, view, frame) : "";
            if (outlet.logs()) row += apps::obstacle_values(session.obstacles(), frame.obstacles, settings);
            detections.add(frame.obstacles, settings.tone.observer.age, settings.glare == render::Glare::Scatter);
            hatch_unseen(frame, settings, a.visible_from);
            relay.deliver(index, outlet.take(index, session, frame, frame.lamps, row), take);
        } else {
            session.skip_frame(), outlet.rows().skip();
        }
        ++index;
    }
    if (!channels && outlet.wanted() && !live) relay.finish(take);
    if (ranks) ranks->end_drive(), session.leave_channels();
    outlet.finish();
    session.stop_recording();
    session.finish_trace();
    if (!a.obstacles.empty()) apps::print_text(detections.table());
    if (!a.detection_plot.empty()) apps::save_plot(a.detection_plot, detections.plot());
    if (live) live->finish(session);
    if (playback.strayed())
        apps::print_note(
            one_line(a.replay) +
            ": the car goes another way than it did when this was recorded, with another version or compiler");
}

}  // namespace vesper::drive
