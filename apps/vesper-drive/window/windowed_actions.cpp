// What keys and buttons do to a drive in a window. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "arguments/tone_arguments.h"
#include "base/error.h"
#include "print.h"
#include "render/passes/operators.h"
#include "window/windowed.h"

namespace vesper::drive {
namespace {

using apps::format;

constexpr double kSunStep = 0.5, kNight = -18;  // degrees
constexpr double kAgeStep = 5, kYoungest = 20, kOldest = 90;

/// The first name with a number that no file has, nor what is left of one.
std::string free_name(const char* before, const char* after) {
    for (unsigned i = 1;; ++i)
        if (std::string name = before + format("%03u", i) + after;
            !std::filesystem::exists(name) && !std::filesystem::exists(io::GrowingFile::part_of(name)))
            return name;
}

std::vector<std::string> choices_of(const char* setting) {
    const auto choices = render::tone_row(setting).choices;
    return {choices.begin(), choices.end()};
}

}  // namespace

void WindowedDrive::change(const std::string& name, const std::string& value) {
    try {
        DriveSettings wanted = session_->settings();
        wanted.set(name, value);
        check_display(wanted);
        session_->set(name, value);
        pace_.restart();
        dirty_ = true;
    } catch (const Error& error) {
        say(error.what(), true);
    }
}

void WindowedDrive::cycle(const std::string& name, const std::vector<std::string>& values, int step) {
    const auto& set = session_->settings().values();
    const auto now = set.find(name);
    const auto at = now == set.end() ? values.begin() : std::find(values.begin(), values.end(), now->second);
    const auto index = at == values.end() ? ptrdiff_t(0) : at - values.begin() + step + ptrdiff_t(values.size());
    change(name, values[size_t(index) % values.size()]);
}

// To the next set of settings; at either end nothing changes.
void WindowedDrive::change_quality(int step) {
    const int now = int(render::quality_named(session_->settings().quality())),
              next = std::clamp(now + step, 0, int(render::kQualityNames.size()) - 1);
    if (next != now) change("quality", std::string(render::kQualityNames[size_t(next)]));
}

void WindowedDrive::next_display() {
    std::vector<std::string> names;
    for (const vision::NamedDisplay& known : vision::known_displays())
        if (screen_->shows(known.display)) names.emplace_back(known.name);
    cycle("display", names, 1);
}

void WindowedDrive::fill_monitor(bool next) {
    const auto now = window_.monitor();
    if (now && !next) return window_.fill(std::nullopt);
    const auto count = unsigned(Window::monitors().size());
    if (count == 0) return say("there is no monitor to fill");
    window_.fill(next && now ? (*now + 1) % count : window_.nearest_monitor());
}

void WindowedDrive::record() {
    if (replay_) return say("a replay is not recorded");
    try {
        if (recording_.empty()) {
            const std::string name = free_name("drive-", ".json");
            session_->record(name, recorded_size());
            recording_ = name;
        } else {
            session_->stop_recording();
            say("recorded " + std::exchange(recording_, {}));
        }
    } catch (const Error& error) {
        recording_.clear();
        say(error.what(), true);
    }
}

void WindowedDrive::save_picture() {
    try {
        const std::string name = free_name("picture-", ".png");
        render::RenderSettings settings = session_->frame_settings();
        settings.scale = picture_scale();
        if (on_device_) draw({.display = true});  // once more, for its codes
        apps::write_codes(name, frame_, settings.display,
                          apps::describe_codes(session_->settings().quality(), settings));
        say("saved " + name);
    } catch (const Error& error) {
        say(error.what(), true);
    }
}

void WindowedDrive::restart() {
    while (session_->finish_oldest(true)) continue;  // what was before is not shown
    if (replay_)
        replay_->rewind(*session_), paused_ = false;
    else
        session_->restart();
    input_devices_.release();
    if (arguments_.autopilot) input_devices_.press(Action::Autopilot);
    instruments_.forget();
    dirty_ = true;
}

void WindowedDrive::press(Action action) {
    if (!replay_ && input_devices_.press(action)) return;
    if (instruments_.press(action)) return;
    switch (action) {
        case Action::Pause:
            paused_ = !paused_;
            break;
        case Action::Step:
            one_step_ = paused_;
            break;
        case Action::Restart:
            restart();
            break;
        case Action::RecordDrive:
            record();
            break;
        case Action::SavePicture:
            save_picture();
            break;
        case Action::Reload:
            reload(arguments_.scene);
            break;
        case Action::Shadows:
            change("shadows", session_->settings().render().shadows ? "off" : "on");
            break;
        case Action::HatchUnseen:
            hatch(!arguments_.hatches);
            break;
        case Action::Leave:
        case Action::Quit:
            window_.close();
            break;
        default:
            press_view(action);
    }
}

void WindowedDrive::press_view(Action action) {
    const render::ToneSettings& tone = session_->settings().render().tone;
    const auto sun = [&](double by) {
        const double now = session_->settings().sun().value_or(kNight) + by;
        change("sun", now <= kNight ? "" : format("%g", std::min(now, 90.0)));
    };
    const auto age = [&](double by) {
        change("age", format("%g", std::clamp(std::round((double(tone.observer.age) + by) / kAgeStep) * kAgeStep,
                                              kYoungest, kOldest)));
    };
    switch (action) {
        case Action::NextCamera:
            cycle("camera", {"driver", "chase", "bird", "free"}, 1);
            break;
        case Action::CameraDriver:
            change("camera", "driver");
            break;
        case Action::CameraChase:
            change("camera", "chase");
            break;
        case Action::CameraBird:
            change("camera", "bird");
            break;
        case Action::CameraFree:
            change("camera", "free");
            break;
        case Action::NextOperator:
            cycle("operator", choices_of("operator"), 1);
            break;
        case Action::PreviousOperator:
            cycle("operator", choices_of("operator"), -1);
            break;
        case Action::NextGlare:
            cycle("glare", choices_of("glare"), 1);
            break;
        case Action::NextDisplay:
            next_display();
            break;
        case Action::OlderObserver:
            age(kAgeStep);
            break;
        case Action::YoungerObserver:
            age(-kAgeStep);
            break;
        case Action::SunUp:
            sun(kSunStep);
            break;
        case Action::SunDown:
            sun(-kSunStep);
            break;
        case Action::FullScreen:
            fill_monitor(false);
            break;
        case Action::NextMonitor:
            fill_monitor(true);
            break;
        case Action::NextVsync:
            screen_settings_.vsync = window::Vsync((unsigned(screen_settings_.vsync) + 1) % 3);
            break;
        case Action::NextScaling:
            screen_settings_.scaling =
                screen_settings_.scaling == window::Scaling::Fit ? window::Scaling::Whole : window::Scaling::Fit;
            break;
        case Action::FinerPicture:
            coarser_ -= coarser_ > 0 ? 1 : 0;
            break;
        case Action::CoarserPicture:
            coarser_ = std::min(coarser_ + 1, kCoarsest);
            break;
        case Action::FasterQuality:
            change_quality(-1);
            break;
        case Action::TruerQuality:
            change_quality(1);
            break;
        default:
            break;
    }
}

}  // namespace vesper::drive
