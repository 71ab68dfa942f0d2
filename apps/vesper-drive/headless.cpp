// Drives without a window: to a film, to pictures, to a log. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "drive.h"
#include "drive_file.h"
#include "drive_log.h"
#include "edge_arguments.h"
#include "indirect_arguments.h"
#include "io/file_gate.h"
#include "io/image_file.h"
#include "message_feed.h"
#include "numbered_files.h"
#include "own_data.h"
#include "picture_arguments.h"
#include "playback.h"
#include "print.h"
#include "progress.h"
#include "session.h"
#include "shadow_arguments.h"
#include "tone_arguments.h"
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
    Outlet(const DriveArguments& a, VkExtent2D extent) : arguments_(a), extent_(extent), probes_(probes_of(a.probes)) {
        if (!a.video.empty()) {
            film_ = a.video.ends_with(".mp4");
            exr_ = a.video.ends_with(".exr");
            if (!film_ && !exr_ && !a.video.ends_with(".png"))
                throw Error("--video " + one_line(a.video) + ": .mp4, .png or .exr is expected");
            if (!film_) names_ = apps::numbered_name("--video", a.video);
            if (!film_ && !names_)
                throw Error("--video " + one_line(a.video) +
                            ": one file a frame needs a number in the name, such as %05d");
            io::announce_write("--video", film_ ? a.video : names_->at(0));
        }
    }
    bool wanted() const { return film_ || names_ || !arguments_.log.empty(); }
    /// Throws Error if pictures with these settings cannot go there, in a film that began with those it was asked of
    /// first.
    void check(const DriveSettings& settings) {
        if (!first_) first_ = settings.render().display;
        const vision::Display &display = settings.render().display, &before = *first_;
        if (exr_ && settings.render().tone_operator == render::Operator::Ldr)
            throw Error("--video " + one_line(arguments_.video) + ": the ldr operator has no luminances to write");
        if (film_ &&
            (display.bits != before.bits || display.eotf != before.eotf || display.primaries != before.primaries))
            throw Error("--video " + one_line(arguments_.video) +
                        ": a film has codes of one kind, and those of this display are others");
    }
    /// Once everything is read, and before anything is written: no name of so many frames may be another file's.
    void open(size_t frames) {
        if (names_) announce_numbered(frames);
        if (!arguments_.log.empty()) log_.emplace(arguments_.log, probes_);
    }
    void add(const traffic::Contact& contact) {
        if (log_) log_->add(contact);
    }
    render::Outputs outputs(const Session& session) const {
        const bool ldr = session.settings().render().tone_operator == render::Operator::Ldr;
        return {.display = film_ || (names_ && !exr_), .scene = exr_ || (log_ && !ldr)};
    }
    /// `shown`: the picture; `logged`: what the log says of it, seen by `view`.
    void take(unsigned index, const Session& session, const gpu_scene::View& view, const render::ToneMapped& shown,
              const render::Frame& logged, double fps) {
        const vision::Display& display = session.settings().render().display;
        if (film_ && !video_)
            video_ = std::make_unique<apps::Video>(arguments_.video, extent_.width, extent_.height, fps, display);
        if (video_) video_->add(shown.display);
        if (names_ && !exr_) apps::write_codes(names_->at(index), shown, display);
        if (names_ && exr_)
            io::write_exr(names_->at(index), extent_.width, extent_.height, shown.scene,
                          header(session, shown, logged.lamps));
        if (log_) log_->add(session, view, logged);
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
    io::Header header(const Session& session, const render::ToneMapped& frame, uint32_t lamps) const {
        std::string options;  // settings other than the defaults
        for (const auto& [name, value] : session.settings().values())
            options += (options.empty() ? "" : " ") + apps::in_shell("--" + name) + " " + apps::in_shell(value);
        const std::string scene = session.scenery().scene().name, own = apps::own_data_name(scene);
        io::Header made{{"vesper:version", VESPER_VERSION},
                        {"vesper:scene", own.empty() ? scene : own},
                        {"vesper:unit", "cd/m^2, linear Rec. 709 RGB"},
                        {"vesper:options", options},
                        {"vesper:seconds", apps::digits(session.world().seconds())},
                        {"vesper:lights", std::to_string(lamps)}};
        const render::RenderSettings& settings = session.settings().render();
        for (const io::Header& part : {apps::describe_edges(settings), apps::describe_tone(settings, frame)})
            made.insert(made.end(), part.begin(), part.end());
        return made;
    }

    const DriveArguments& arguments_;
    VkExtent2D extent_;
    std::vector<LogProbe> probes_;
    bool film_ = false, exr_ = false;
    std::optional<vision::Display> first_;
    std::optional<apps::NumberedName> names_;
    std::unique_ptr<apps::Video> video_;
    std::optional<DriveLog> log_;
};

// One picture of all channels; the log is of the one that is looked at.
void take_wall(Outlet& outlet, unsigned index, Session& session, const Channels& channels, double fps) {
    ChannelMosaic wall = session.render(channels, outlet.outputs(session));
    const render::Frame logged = looked_at(wall, channels);
    outlet.take(index, session, channel_view(channels.screens[channels.gaze], session.view({1, 1})), wall.shown, logged,
                fps);
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
        : feed_(osi::parse_address(a.osi_udp), a.osi_delay) {
        apps::print_note("listening at " + feed_.place());
        if (!feed_.wait_for(session, 0, kFirst)) throw Error("--osi-udp " + a.osi_udp + ": no message came in 30 s");
        playback.live_moment = [this, &session] {
            moment_ += session.options().time_step;
            if (!feed_.wait_for(session, moment_, kFirst)) over_ = true;
            return std::optional(moment_);
        };
    }
    bool is_over() const { return over_; }
    void finish() { apps::print_note(feed_.report() + (over_ ? "; the sender is silent, and the drive is over" : "")); }

private:
    static constexpr std::chrono::seconds kFirst{30};
    MessageFeed feed_;
    double moment_ = 0;
    bool over_ = false;
};

}  // namespace

void run_headless(const DriveArguments& a) {
    std::optional<Channels> channels;
    if (!a.channels.empty()) channels = read_channels(a.channels);
    Drive drive;
    const bool replays = !a.replay.empty();
    if (replays) drive = read_drive(a.replay);
    const VkExtent2D extent = channels                            ? extent_of(*channels)
                              : drive.start.size && !a.size_given ? VkExtent2D{drive.start.size->x, drive.start.size->y}
                                                                  : apps::parse_size(a.size);
    Outlet outlet(a, extent);
    const DriveStart options = start_of(a, drive.start);
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
        throw Error("nothing to do: give --video, --log, --record or --osi-out");
    gpu::Device device({.select = a.device});
    Session session(device, options, std::move(scenery));
    const std::shared_ptr<Cache> cache = apps::shadow_cache(a.shadow_cache);
    session.keep_maps(cache);
    const render::RenderSettings& shown = session.settings().render();
    if (outlet.wanted() && shown.indirect && shown.tone_operator != render::Operator::Ldr) {
        const gpu_scene::SceneFrame rest = session.moment();
        session.set_radiosity(apps::gathered(session.scenery().scene(), rest.world, rest.moving, cache.get()));
    }
    session.on_maps = [](const render::MapReport& report) { apps::print_cache_note(report.note); };
    Playback playback(std::move(drive.events), a.settings);
    std::optional<Live> live;
    if (a.messages.live) live.emplace(a, session, playback);
    outlet.open(playback.frames());
    session.on_contact = [&](const traffic::Contact& contact) { outlet.add(contact); };
    apps::print_notes(session.scenery().notes());
    if (!a.osi_out.empty()) session.write_trace(a.osi_out);
    if (!a.record.empty())
        session.record(a.record, outlet.wanted() && !channels ? std::optional(glm::uvec2(extent.width, extent.height))
                                                              : std::nullopt);
    apps::Progress progress(replays ? "replaying" : "driving", unsigned(std::max<size_t>(1, playback.frames())));
    unsigned index = 0;
    while (const auto kind = playback.next(session)) {
        if (live && live->is_over()) break;
        if (kind != DriveEvent::Kind::Frame || !outlet.wanted()) continue;
        if (channels) {
            take_wall(outlet, index++, session, *channels, fps);
        } else {
            const gpu_scene::View view = session.view(extent);
            const render::Frame frame = session.render(view, outlet.outputs(session));
            outlet.take(index++, session, view, frame, frame, fps);
        }
        progress.step();
    }
    outlet.finish();
    session.stop_recording();
    session.finish_trace();
    if (live) live->finish();
    if (playback.strayed())
        apps::print_note(
            one_line(a.replay) +
            ": the car goes another way than it did when this was recorded, with another version or compiler");
}

}  // namespace vesper::drive
