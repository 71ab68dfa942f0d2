// Obstacles that are watched from a window. SPDX-License-Identifier: MIT
#include <algorithm>

#include "base/error.h"
#include "obstacle_arguments.h"
#include "windowed.h"

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
    arguments_.hatches = on, stale_ = true;
    session_->find_obstacle_pixels(on);
}

}  // namespace vesper::drive
