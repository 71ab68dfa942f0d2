#include "window/windowed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <thread>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "arguments/cache_arguments.h"
#include "arguments/obstacle_arguments.h"
#include "arguments/picture_arguments.h"
#include "arguments/tone_arguments.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/one_line.h"
#include "print.h"
#include "render/passes/operators.h"
#include "scaled_picture.h"
#include "window/channel_window.h"

namespace vesper::drive {
namespace {

using apps::format;

constexpr double kMostBehind = 0.25;  // s: where a device is slower than that, time goes slower
constexpr std::array<double, WindowedDrive::kCoarsest + 1> kCoarser{1, 1.25, 1.5, 2, 3, 4};

const char* name_of(CameraKind camera) {
    switch (camera) {
        case CameraKind::Chase:
            return "chase";
        case CameraKind::Bird:
            return "bird";
        case CameraKind::Free:
            return "free";
        default:
            return "driver";
    }
}

WindowSettings window_settings(const DriveArguments& a) {
    return {.title = "Vesper",
            .extent = apps::parse_size(a.window, 64),
            .monitor = a.full_screen < 0 ? std::nullopt : std::optional(unsigned(a.full_screen))};
}

}  // namespace

WindowedDrive::WindowedDrive(const DriveArguments& a)
    : arguments_(a),
      window_(window_settings(a)),
      device_(std::make_unique<gpu::Device>(device_options())),
      screen_(std::make_unique<Screen>(window_, *device_)),
      screen_settings_{.vsync = vsync_of(a.vsync),
                       .scaling = a.scaling == "whole" ? window::Scaling::Whole : window::Scaling::Fit},
      input_devices_(a.controllers.empty() ? std::vector<ControllerMapping>() : read_controllers(a.controllers)) {
    if (a.size_given) size_ = apps::parse_size(a.size);
    if (!a.channels.empty()) channels_ = read_channels(a.channels);
    if (apps::Ranks::several()) ranks_ = std::make_unique<ChannelRanks>(apps::Ranks::all(), *channels_);
    Drive drive;
    if (!a.replay.empty()) {
        drive = read_drive(a.replay);
        arguments_.scene = drive.start.scene.string();
        arguments_.messages = drive.start.messages;
        if (drive.start.size && !a.size_given) size_ = VkExtent2D{drive.start.size->x, drive.start.size->y};
        if (!drive.complete) say(a.replay + " breaks off; what there is of it is shown");
    }
    open_session(drive);
    if (ranks_) {
        const std::vector<size_t> own = ranks_->own(channels_->screens.size());
        check_displays(*channels_, session_->settings().render().display);
        if (const auto monitor = monitor_of(*channels_, own); monitor && a.full_screen < 0) window_.fill(monitor);
        apps::Ranks::all().agree_on_start();
        apps::Ranks::all().in_turns([&] {
            if (!own.empty()) session_->gather_light(map_cache_.get());
        });
        ranks_->lead(*session_);
    }
    if (!a.replay.empty()) replay_.emplace(std::move(drive.events), a.settings);
    if (a.messages.live) open_feed();
    if (!a.osi_out.empty()) session_->write_trace(a.osi_out);
    if (!a.record.empty()) session_->record(a.record, recorded_size()), recording_ = a.record;
    if (a.autopilot) input_devices_.press(Action::Autopilot);
    if (!a.log.empty())
        log_.emplace(a.log, probes_of(a.probes), ranks_ ? kMeetingColumns : apps::obstacle_columns(obstacles_));
    window_.on_key = [this](int key, int modifiers) {
        const auto action = action_of(key, modifiers);
        if (!action || screen_->is_typing()) return;
        // Letters and the space bar belong to the instruments while they have the keyboard.
        const bool theirs =
            key < GLFW_KEY_F1 && *action != Action::Focus && *action != Action::Leave && *action != Action::Quit;
        if (instruments_.has_keyboard() && theirs) return;
        press(*action);
    };
    window_.on_drop = [this](const std::string& file) { reload(file); };
}

gpu::DeviceOptions WindowedDrive::device_options() const {
    return {.select = arguments_.device, .validation = false, .on_message = {}, .presentation = window_.presentation()};
}

void WindowedDrive::recover(const gpu::DeviceLost& error) {
    if (ranks_ || !std::exchange(shown_, false)) throw error;
    screen_.reset();
    auto device = std::make_unique<gpu::Device>(device_options());
    session_->use(*device);
    device_ = std::move(device);
    screen_ = std::make_unique<Screen>(window_, *device_);
    dirty_ = true;
    say(std::string(error.what()) + "; it was opened anew", true);
}

void WindowedDrive::check_display(const DriveSettings& settings) const {
    if (!screen_->shows(settings.render().display))
        throw Error(
            "--display: this window shows no codes of that kind (HDR10 needs a screen and a system that offer it)");
}

void WindowedDrive::open_session(const Drive& drive) {
    const DriveStart start = start_of(arguments_, drive.start);
    Scenery scenery(start.scene, start.messages);
    check_settings(
        drive, arguments_.settings, [&](const DriveSettings& settings) { check_display(scenery.check(settings)); },
        [](const DriveSettings&) {});
    session_ = std::make_unique<Session>(*device_, start, std::move(scenery));
    obstacles_ = apps::obstacles_of(session_->scenery().scene(), arguments_.obstacles, session_->settings().render());
    session_->watch(obstacles_), session_->find_obstacle_pixels(arguments_.hatches);
    if (channels_) session_->share_channels(ranks_.get(), arguments_.latency);
    watch_contacts();
    keep_maps();
    apps::print_notes(session_->scenery().notes());
    if (const double side = scale(); side < 1)
        apps::print_note(
            format("each side of pictures is rendered with %g of its pixels, and enlarged (--scale)", side));
}

// A scene that cannot be used leaves everything as it is.
void WindowedDrive::reload(const std::string& scene) {
    if (ranks_) return say("several ranks show this drive: another scene needs a new start", true);
    const bool same = scene == arguments_.scene;  // then what moves on it, too
    bool watches = true;
    DriveSettings::Values settings = session_->settings().values();
    if (!same)
        std::erase_if(settings, [](const auto& setting) {
            return setting.first.starts_with("lamp:");
        });  // of lamps that only the old scene has
    try {
        auto made =
            std::make_unique<Session>(*device_, DriveStart{.scene = scene,
                                                           .messages = same ? arguments_.messages : MessageSource{},
                                                           .seed = arguments_.seed,
                                                           .settings = settings,
                                                           .quality = session_->options().quality});
        watches = watch_again(*made);
        if (!recording_.empty()) session_->stop_recording();
        light_.reset(), session_ = std::move(made), feed_.reset();
        if (same && arguments_.messages.live) open_feed();
        if (channels_) session_->share_channels(nullptr, arguments_.latency);
        watch_contacts();
        keep_maps();
    } catch (const Error& error) {
        return say(error.what(), true);
    }
    if (!same) arguments_.messages = {};
    arguments_.scene = scene;
    recording_.clear(), replay_.reset(), instruments_.forget();
    if (!arguments_.size_given) size_.reset();
    dirty_ = true, pace_.restart();
    say("loaded " + scene + (watches ? "" : "; it has other obstacles, which are not watched"), !watches);
}

void WindowedDrive::say(const std::string& text, bool alarm) {
    message_ = text, alarm_ = alarm;
    message_until_ = Clock::now() + std::chrono::seconds(alarm ? 15 : 5);
    if (alarm) apps::print_error("vesper-drive", text);
}

std::string WindowedDrive::title() const {
    std::string text = std::filesystem::path(arguments_.scene).filename().string() +
                       format(", %.1f s, ", session_->world().seconds()) +
                       apps::name_of(session_->settings().render().tone_operator) + ", " +
                       name_of(session_->settings().camera());
    if (replay_) text += ", replay";
    if (paused_) text += ", paused";
    if (!recording_.empty()) text += ", recording";
    if (scale() < 1) text += format(", rendered at %ux%u", rendered_.width, rendered_.height);
    return text + " - Vesper";
}

VkExtent2D WindowedDrive::picture_extent(double scale) const {
    const VkExtent2D whole = size_.value_or(window_.extent());
    scale /= kCoarser[coarser_];
    return {apps::scaled(whole.width, scale), apps::scaled(whole.height, scale)};
}

double WindowedDrive::scale() const {
    return arguments_.scale_given ? arguments_.scale : session_->settings().render().scale;
}

double WindowedDrive::picture_scale() const { return channels_ ? 1 : scale() / kCoarser[coarser_]; }

std::optional<glm::uvec2> WindowedDrive::recorded_size() const {
    const VkExtent2D extent = picture_extent(1);
    return channels_ ? std::nullopt : std::optional(glm::uvec2(extent.width, extent.height));
}

HeldInput WindowedDrive::held() const {
    if (instruments_.has_keyboard() || screen_->is_typing()) return {};
    const bool letters = session_->settings().camera() != CameraKind::Free;
    const auto down = [&](int arrow, int letter) {
        return window_.is_pressed(arrow) || (letters && window_.is_pressed(letter));
    };
    return {.left = down(GLFW_KEY_LEFT, GLFW_KEY_A),
            .right = down(GLFW_KEY_RIGHT, GLFW_KEY_D),
            .accelerate = down(GLFW_KEY_UP, GLFW_KEY_W),
            .brake = down(GLFW_KEY_DOWN, GLFW_KEY_S)};
}

void WindowedDrive::move_camera(double seconds) {
    const glm::dvec2 mouse = window_.mouse(), moved = mouse - std::exchange(mouse_, mouse);
    if (session_->settings().camera() != CameraKind::Free || instruments_.has_keyboard() || screen_->is_typing())
        return;
    constexpr double kSpeed = 8, kTurn = 0.8, kDrag = 0.003;  // m/s, rad/s, rad/px
    const auto axis = [&](int plus, int minus) {
        return (window_.is_pressed(plus) ? 1.0 : 0.0) - (window_.is_pressed(minus) ? 1.0 : 0.0);
    };
    const double ahead = axis(GLFW_KEY_W, GLFW_KEY_S), left = axis(GLFW_KEY_A, GLFW_KEY_D),
                 up = axis(GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_DOWN);
    const bool turns = window_.is_pressed(GLFW_KEY_LEFT_SHIFT) || window_.is_pressed(GLFW_KEY_RIGHT_SHIFT),
               drags = window_.is_button_pressed(GLFW_MOUSE_BUTTON_RIGHT);
    FreeCamera c = session_->settings().free_camera();
    const FreeCamera before = c;
    if (drags) c.yaw += kDrag * moved.x, c.pitch += kDrag * moved.y;
    if (turns) {
        c.yaw += kTurn * left * seconds, c.pitch += kTurn * ahead * seconds;
    } else {
        const glm::dvec3 forward(-std::sin(c.yaw), 0, -std::cos(c.yaw)), sideways(forward.z, 0, -forward.x);
        c.position += kSpeed * seconds * (ahead * forward + left * sideways);
    }
    c.position.y += kSpeed * seconds * up;
    c.pitch = std::clamp(c.pitch, -1.5, 1.5);
    if (c.position == before.position && c.yaw == before.yaw && c.pitch == before.pitch) return;
    change("free", format("%.4f,%.4f,%.4f,%.4f,%.4f", c.position.x, c.position.y, c.position.z,
                          c.yaw * kDegreesPerRadian, c.pitch * kDegreesPerRadian));
}

bool WindowedDrive::replay_to_next_frame() {
    while (const auto kind = replay_->next(*session_)) {
        if (kind == DriveEvent::Kind::Frame) return true;
        if (kind == DriveEvent::Kind::Restart) instruments_.forget();
        if (kind == DriveEvent::Kind::Step) lag_s_ -= session_->options().time_step;
        // A drive that was recorded without frames is shown step by step.
        if (kind == DriveEvent::Kind::Step && lag_s_ <= 0 && replay_->frames() == 0) return true;
    }
    paused_ = true;
    say(replay_->strayed() ? "the replay is over; the car went another way than when it was recorded"
                           : "the replay is over; Backspace starts it again");
    return true;
}

// What the world does in so much real time, and a picture of that if anything is new.
void WindowedDrive::advance(double seconds) {
    take_finished();
    const double step = session_->options().time_step;
    lag_s_ = paused_ ? 0 : std::min(lag_s_ + seconds, kMostBehind);
    if (std::exchange(one_step_, false)) lag_s_ = step;
    bool moved = false;
    if (replay_) {
        if (lag_s_ >= step) moved = replay_to_next_frame();
    } else {
        listen();
        const Clock::time_point now = Clock::now();
        for (; lag_s_ >= step; lag_s_ -= step, moved = true)
            session_->step(input_devices_.next(held(), session_->world().driver().speed, step),
                           feed_ ? feed_->shown(now - std::chrono::duration_cast<Clock::duration>(
                                                          std::chrono::duration<double>(lag_s_ - step)))
                                 : std::nullopt);
    }
    render(moved);
}

void WindowedDrive::open_feed() {
    feed_ = std::make_unique<MessageFeed>(osi::parse_address(arguments_.osi_udp), arguments_.osi_delay);
}

// Messages that cannot be used are told of, at most each 5 s.
void WindowedDrive::listen() {
    if (!feed_ || paused_) return;  // what comes meanwhile waits, within the bounds of a Receiver
    feed_->listen(*session_);
    if (const bool raises = session_->raises_objects(); raises != raises_) {
        raises_ = raises;
        say(raises ? kRaised : "base.position of the objects is taken as the middle of their boxes");
    }
    if (const std::vector<std::string> doubts = feed_->doubts(); doubts.size() != doubts_) {
        doubts_ = doubts.size();
        for (const std::string& doubt : doubts) say(doubt);
    }
    const uint64_t count = feed_->counts().unusable();
    if (count == troubles_ || Clock::now() - troubles_said_ < std::chrono::seconds(5)) return;
    troubles_ = count, troubles_said_ = Clock::now();
    say(feed_->report());
}

void WindowedDrive::watch_contacts() {
    session_->on_contact = [this](const traffic::Contact& contact) {
        say(format("collision with %s at %.0f km/h", contact.node.c_str(), contact.speed * 3.6));
        if (log_) log_->rows().add(contact);
    };
}

void WindowedDrive::keep_maps() {
    if (!map_cache_) map_cache_ = apps::cache_of(arguments_.cache);
    session_->keep_maps(map_cache_);
    session_->on_maps = [](const render::ShadowReport& report) { apps::print_cache_note(report.note); };
}

// What is known of the light between surfaces; the first time that it is wanted its work begins.
void WindowedDrive::take_light() {
    if (ranks_ || !session_->settings().render().indirect) return;
    if (!light_) {
        gpu_scene::SceneFrame rest = session_->moment();
        light_ = std::make_unique<LightGatherer>(session_->scenery().scene(), std::move(rest.world),
                                                 std::move(rest.moving), apps::cache_of(arguments_.cache));
    }
    try {
        if (auto radiosity = light_->take()) session_->set_radiosity(std::move(radiosity)), dirty_ = true;
        apps::print_cache_note(light_->problem());
    } catch (const gpu::DeviceLost&) {
        throw;
    } catch (const Error& error) {
        say(error.what(), true);
    }
}

// What the window says while no message is shown.
std::string WindowedDrive::standing_message() const {
    if (ranks_ && !meeting_.empty()) return meeting_note_;
    if (feed_ && feed_->counts().messages == 0) return "listening at " + feed_->place() + ": no message yet";
    if (session_->external().without_body > 0)
        return format("%zu objects are not shown: there are too many at once", session_->external().without_body);
    if (!light_ || light_->done() || !session_->settings().render().indirect) return {};
    return format("light between surfaces: %.0f %%, rough until then", 100 * light_->share());
}

// Where pictures are slow by themselves: what would help, and its key. Work that ends by itself slows them, too.
std::string WindowedDrive::offer() const {
    const bool limited = arguments_.limit > 0 && arguments_.limit < Pace::kSlow, gathers = light_ && !light_->done();
    const auto faster = pace_.offer(render::quality_named(session_->settings().quality()));
    if (limited || gathers) return {};
    if (!faster && pace_.crawls())
        return format("fewer than %.0f pictures/s: a smaller --size or --scale, or --shadows off", Pace::kCrawl);
    if (!faster) return {};
    return format("fewer than %.0f pictures/s: T takes quality %s", Pace::kSlow,
                  std::string(render::kQualityNames[size_t(*faster)]).c_str());
}

void WindowedDrive::run() {
    Clock::time_point last = Clock::now();
    while (!window_.is_closing()) {
        window_.poll(window_.is_minimised() ? 0.1 : 0);
        for (const Action action : input_devices_.look(plugged_in())) press(action);
        if (const std::string notice = input_devices_.take_notice(); !notice.empty()) say(notice);
        const Clock::time_point now = Clock::now();
        const double elapsed = std::chrono::duration<double>(now - last).count();
        last = now;
        if (window_.is_minimised()) continue;  // nobody sees where the car goes: time stands still
        pictures_per_second_ += (1 / std::max(elapsed, 1e-4) - pictures_per_second_) * std::min(1.0, elapsed / 0.5);
        pace_.add(elapsed);
        move_camera(elapsed);
        try {
            advance(elapsed);
            present();
        } catch (const gpu::DeviceLost& error) {
            recover(error);
        } catch (const Error& error) {
            // A full disk ends the recording, not the drive.
            if (recording_.empty() || session_->recording()) throw;
            say(error.what(), true);
        }
        if (!session_->recording()) recording_.clear();
        window_.set_title(title());
        const double least = paused_ ? 1.0 / 60 : arguments_.limit > 0 ? 1 / arguments_.limit : 0;
        std::this_thread::sleep_until(
            now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(least)));
    }
    if (ranks_) ranks_->end_drive(), session_->leave_channels();
    if (!recording_.empty()) session_->stop_recording();
    session_->finish_trace();
    if (log_) log_->complete();
}

void run_windowed(const DriveArguments& arguments) {
    if (apps::Ranks::several()) {
        if (arguments.channels.empty()) throw Error("several ranks open windows for --channels, or none (--headless)");
        if (apps::Ranks::own_number() != 0) return show_channels(arguments);
    }
    WindowedDrive drive(arguments);
    try {
        drive.run();
    } catch (const Error& error) {
        if (drive.recording().empty()) throw;
        throw Error(std::string(error.what()) + "; the drive up to then is in " +
                    one_line(io::GrowingFile::part_of(drive.recording())));
    }
}

}  // namespace vesper::drive
