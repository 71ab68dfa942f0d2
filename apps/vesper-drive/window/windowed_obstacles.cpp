// Obstacles that are watched from a window, and its log. SPDX-License-Identifier: MIT
#include <algorithm>

#include "arguments/obstacle_arguments.h"
#include "base/error.h"
#include "window/windowed.h"

namespace vesper::drive {

// Columns of a log stay those of the first scene: in another one the same obstacles are watched, or none.
bool WindowedDrive::watch_again(Session& session) const {
    if (obstacles_.empty()) return true;
    const auto same = [](const scene::Obstacle& a, const scene::Obstacle& b) { return a.name == b.name; };
    try {
        std::vector<scene::Obstacle> found = apps::obstacles_of(session.scenery().scene(), arguments_.obstacles, {});
        if (!std::equal(found.begin(), found.end(), obstacles_.begin(), obstacles_.end(), same)) return false;
        session.watch(std::move(found)), session.find_obstacle_pixels(arguments_.hatches);
    } catch (const Error&) {
        return false;
    }
    return true;
}

void WindowedDrive::hatch(bool on) {
    if (obstacles_.empty()) return say("no obstacles are watched (--obstacle)");
    arguments_.hatches = on, dirty_ = true;
    session_->find_obstacle_pixels(on);
}

// A log that cannot be written ends, not the drive.
void WindowedDrive::log_frame() {
    try {
        if (!ranks_)
            row_ =
                log_->rows().next(
                    *session_, channels_ ? channel_view(channels_->screens[channels_->gaze], view_) : view_, frame_) +
                apps::obstacle_values(obstacles_, frame_.obstacles, session_->settings().render());
        log_->append(row_, meeting_);
    } catch (const Error& error) {
        log_.reset();
        say("--log " + std::string(error.what()), true);
    }
}

}  // namespace vesper::drive
