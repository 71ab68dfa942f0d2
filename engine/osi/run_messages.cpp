#include "osi/run_messages.h"

#include <algorithm>
#include <cmath>

#include "base/budget.h"

namespace vesper::osi {
namespace {

using roads::RunEntity, roads::RunPose;

static_assert(int(RunEntity::Kind::Object) == int(MovingObject::Kind::Object));

struct Box {
    glm::dvec3 size, centre;  // length, width, height; its middle ahead, left and up of the reference point, m
};

// As the table states it, or a usual one. The reference point of vehicles is the middle of the rear axle, on the
// ground.
Box box_of(const RunEntity& e, MovingObject::Kind kind) {
    if (e.length > 0 && e.width > 0 && e.height > 0) return {{e.length, e.width, e.height}, e.centre};
    const glm::dvec3 usual = usual_size(kind);
    return {usual, {kind < MovingObject::Kind::Bicycle ? 0.3 * usual.x : 0, 0, usual.z / 2}};
}

}  // namespace

std::vector<Message> messages_of(const roads::EsminiRun& run) {
    std::vector<int64_t> times;
    const auto nanoseconds = [](double seconds) { return int64_t(std::llround(seconds * 1e9)); };
    uint64_t rows = 0;
    for (const RunEntity& e : run.entities) {
        rows += e.poses.size();
        for (const RunPose& p : e.poses) times.push_back(nanoseconds(p.time));
    }
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    spend(times.size() * sizeof(Message) + rows * sizeof(MovingObject));
    std::vector<Message> messages(times.size());
    for (size_t i = 0; i < times.size(); ++i) messages[i].nanoseconds = times[i];
    for (size_t i = 0; i < run.entities.size(); ++i) {
        const RunEntity& e = run.entities[i];
        const auto kind = MovingObject::Kind(e.kind);
        const Box box = box_of(e, kind);
        const auto first = std::lower_bound(times.begin(), times.end(), nanoseconds(e.poses.front().time)),
                   last = std::lower_bound(first, times.end(), nanoseconds(e.poses.back().time));
        for (auto time = first; time <= last; ++time) {
            const RunPose p = roads::pose_at(e, 1e-9 * double(*time));
            const glm::dmat3 axes = axes_of(p.heading, p.pitch, p.roll);
            messages[size_t(time - times.begin())].objects.push_back({.id = i,
                                                                      .kind = kind,
                                                                      .model = e.name,
                                                                      .size = box.size,
                                                                      .centre = p.position + axes * box.centre,
                                                                      .yaw = p.heading,
                                                                      .pitch = p.pitch,
                                                                      .roll = p.roll,
                                                                      .velocity = p.speed * axes[0],
                                                                      .lights = {}});
        }
    }
    return messages;
}

}  // namespace vesper::osi
