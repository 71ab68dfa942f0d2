// Drives without a window: to a film, to pictures, to a log. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <filesystem>

#include "arguments.h"
#include "base/error.h"
#include "drive.h"
#include "drive_file.h"
#include "drive_log.h"
#include "io/atomic_file.h"
#include "io/image_file.h"
#include "numbered_files.h"
#include "picture_arguments.h"
#include "progress.h"
#include "session.h"
#include "tone_arguments.h"
#include "video.h"

namespace vesper {
namespace {

std::vector<LogProbe> probes_of(const std::vector<std::string>& texts) {
    std::vector<LogProbe> probes;
    for (const std::string& text : texts) {
        char* end = nullptr;
        const double x = std::strtod(text.c_str(), &end);
        const double y = *end == ',' ? std::strtod(end + 1, &end) : -1;
        if (*end || !(x >= 0 && x <= 1 && y >= 0 && y <= 1)) throw Error("--probe " + one_line(text) + ": X,Y from 0 to 1 are expected");
        probes.push_back({{x, y}});
    }
    return probes;
}

// Steps of time with frames at an even rate among them.
std::vector<DriveEvent> evenly(const std::vector<DriveEvent>& events, double time_step, double fps) {
    const DriveEvent frame{.kind = DriveEvent::Kind::Frame, .name = {}, .value = {}};
    std::vector<DriveEvent> made{frame};
    uint64_t steps = 0, frames = 1;
    for (const DriveEvent& event : events) {
        if (event.kind == DriveEvent::Kind::Frame) continue;
        made.push_back(event);
        // The first step that has reached the frame's time; at most one frame a step.
        if (event.kind != DriveEvent::Kind::Step || double(++steps) * time_step * fps < double(frames) - 1e-6) continue;
        made.push_back(frame);
        frames = std::max(frames + 1, uint64_t(double(steps) * time_step * fps + 1e-6) + 1);
    }
    return made;
}

size_t frames_in(const std::vector<DriveEvent>& events) {
    return size_t(std::count_if(events.begin(), events.end(), [](const DriveEvent& e) { return e.kind == DriveEvent::Kind::Frame; }));
}

// Frames a second that a film of recorded frames plays with.
double rate_of(const std::vector<DriveEvent>& events, double time_step) {
    std::vector<unsigned> strides;
    unsigned steps = 0;
    for (const DriveEvent& event : events) {
        if (event.kind == DriveEvent::Kind::Step) ++steps;
        if (event.kind == DriveEvent::Kind::Frame && steps > 0) strides.push_back(std::exchange(steps, 0));
    }
    if (strides.empty()) return 30;
    std::nth_element(strides.begin(), strides.begin() + strides.size() / 2, strides.end());
    return 1 / (strides[strides.size() / 2] * time_step);
}

/// Where frames go.
class Outlet {
public:
    Outlet(const DriveArguments& a, VkExtent2D extent) : arguments_(a), extent_(extent), probes_(probes_of(a.probes)) {
        if (!a.video.empty()) {
            film_ = a.video.ends_with(".mp4");
            exr_ = a.video.ends_with(".exr");
            if (!film_ && !exr_ && !a.video.ends_with(".png")) throw Error("--video " + one_line(a.video) + ": .mp4, .png or .exr is expected");
            if (!film_) names_ = numbered_name("--video", a.video);
            if (!film_ && !names_) throw Error("--video " + one_line(a.video) + ": one file a frame needs a number in the name, such as %05d");
            for (const std::string& file : {a.scene, a.replay, a.run, a.scenario, a.channels, a.record, a.log})
                if (!file.empty()) others_.insert(std::filesystem::weakly_canonical(std::filesystem::absolute(file)));
            if (film_) check_free(a.video);
            Files files;
            files.writes("--video", film_ ? a.video : names_->at(0));
        }
        if (!a.log.empty()) log_ = drive_log_heading(probes_);
    }
    bool wanted() const { return film_ || names_ || !log_.empty(); }
    Outputs outputs(const Session& session) const {
        const bool ldr = session.settings().render().tone_operator == Operator::Ldr;
        if (ldr && exr_) throw Error("--video " + arguments_.video + ": the ldr operator has no luminances to write");
        return {.display = film_ || (names_ && !exr_), .scene = exr_ || (!log_.empty() && !ldr)};
    }
    /// `shown`: the picture; `logged`: what the log says of it, seen by `view`.
    void take(unsigned index, const Session& session, const View& view, const ToneMapped& shown, const Frame& logged, double fps) {
        const Display& display = session.settings().render().display;
        if (film_ && !video_) video_ = std::make_unique<Video>(arguments_.video, extent_.width, extent_.height, fps, display);
        if (video_) video_->add(shown.display);
        if (names_) check_free(names_->at(index));
        if (names_ && !exr_) write_codes(names_->at(index), shown, display);
        if (names_ && exr_) write_exr(names_->at(index), extent_.width, extent_.height, shown.scene, header(session, shown, logged.lights));
        if (!log_.empty()) log_ += drive_log_row(index, session, view, logged, probes_);
    }
    void finish() {
        if (video_) video_->finish();
        if (!log_.empty()) write_text(arguments_.log, log_);
    }

private:
    void check_free(const std::string& file) const {
        if (others_.contains(std::filesystem::weakly_canonical(std::filesystem::absolute(file)))) throw Error("--video " + one_line(file) + ": is read or written for something else");
    }
    Header header(const Session& session, const ToneMapped& frame, uint32_t lights) const {
        Header made{{"vesper:version", VESPER_VERSION},
                    {"vesper:scene", session.scenery().scene().name},
                    {"vesper:unit", "cd/m^2, linear Rec. 709 RGB"},
                    {"vesper:seconds", digits(session.world().seconds())},
                    {"vesper:lights", std::to_string(lights)}};
        const Header tone = describe_tone(session.settings().render(), frame);
        made.insert(made.end(), tone.begin(), tone.end());
        return made;
    }

    const DriveArguments& arguments_;
    VkExtent2D extent_;
    std::vector<LogProbe> probes_;
    bool film_ = false, exr_ = false;
    std::optional<NumberedName> names_;
    std::set<std::filesystem::path> others_;  // files that no frame may replace
    std::unique_ptr<Video> video_;
    std::string log_;
};

// One picture of all channels; the log is of the one that is looked at.
void take_wall(Outlet& outlet, unsigned index, Session& session, const Channels& channels, double fps) {
    Wall wall = session.render(channels, outlet.outputs(session));
    const Frame logged = looked_at(wall, channels);
    outlet.take(index, session, channel_view(channels.screens[channels.gaze], session.view({1, 1})), wall.shown, logged, fps);
}

VkExtent2D extent_of(const Channels& channels) {
    VkExtent2D extent{0, 0};
    for (const ScreenChannel& c : channels.screens) extent = {extent.width + c.extent.width, std::max(extent.height, c.extent.height)};
    return extent;
}

}  // namespace

void run_headless(const DriveArguments& a) {
    std::optional<Channels> channels;
    if (!a.channels.empty()) channels = read_channels(a.channels);
    const VkExtent2D extent = channels ? extent_of(*channels) : parse_size(a.size);
    Outlet outlet(a, extent);
    std::optional<Drive> replayed;
    if (!a.replay.empty()) replayed = read_drive(a.replay);
    const DriveStart options = start_of(a, replayed);
    std::vector<DriveEvent> events;
    if (replayed) {
        if (!replayed->complete) std::fprintf(stderr, "note: %s breaks off; what there is of it is driven\n", a.replay.c_str());
        events = std::move(replayed->events);
    } else {
        DriverInput input{.autopilot = a.autopilot};
        events.assign(size_t(std::lround(a.seconds / options.time_step)), {.kind = DriveEvent::Kind::Step, .input = input, .name = {}, .value = {}});
    }
    const bool own_frames = frames_in(events) > 0 && a.fps == 0;
    if (outlet.wanted() && !own_frames) events = evenly(events, options.time_step, a.fps > 0 ? a.fps : 30);
    const double fps = own_frames ? rate_of(events, options.time_step) : std::min(a.fps > 0 ? a.fps : 30, 1 / options.time_step);
    if (!outlet.wanted() && a.record.empty()) throw Error("nothing to do: give --video, --log or --record");

    Device device({.select = a.device});
    Session session(device, options);
    for (const std::string& note : session.scenery().notes()) std::fprintf(stderr, "note: %s\n", note.c_str());
    if (!a.record.empty()) session.record(a.record);
    Progress progress(a.replay.empty() ? "driving" : "replaying", unsigned(std::max<size_t>(1, frames_in(events))));
    unsigned index = 0;
    bool strayed = false;
    for (const DriveEvent& event : events) {
        switch (event.kind) {
            case DriveEvent::Kind::Set:
                if (!a.settings.contains(event.name)) session.set(event.name, event.value);
                break;
            case DriveEvent::Kind::Restart: session.restart(); break;
            case DriveEvent::Kind::Step: {
                session.step(event.input);
                const VehicleState& me = session.world().driver();
                strayed |= !a.replay.empty() && glm::dvec4(me.position, me.yaw, me.speed) != event.pose;
                break;
            }
            case DriveEvent::Kind::Frame: {
                if (!outlet.wanted()) break;
                if (channels) {
                    take_wall(outlet, index++, session, *channels, fps);
                } else {
                    const View view = session.view(extent);
                    const Frame frame = session.render(view, outlet.outputs(session));
                    outlet.take(index++, session, view, frame, frame, fps);
                }
                progress.step();
                break;
            }
        }
    }
    outlet.finish();
    session.stop_recording();
    if (strayed) std::fprintf(stderr, "note: %s: the car goes another way than it did when this was recorded, with another version or compiler\n", a.replay.c_str());
}

}  // namespace vesper
