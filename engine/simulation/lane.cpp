#include "simulation/lane.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"

namespace vesper {

Lane::Lane(std::string name, std::vector<glm::dvec3> points, double width, double speed)
    : name_(std::move(name)), points_(std::move(points)), width_(width), speed_(speed) {
    if (points_.size() < 2) throw Error("lane " + name_ + ": at least two points are needed");
    starts_.push_back(0);
    std::vector<double> segments;  // yaw of each
    for (size_t i = 1; i < points_.size(); ++i) {
        const glm::dvec3 d = points_[i] - points_[i - 1];
        const double length = std::hypot(d.x, d.z);
        if (!(length > 1e-6)) throw Error("lane " + name_ + ": points " + std::to_string(i - 1) + " and " + std::to_string(i) + " are the same");
        starts_.push_back(starts_.back() + length);
        double yaw = std::atan2(-d.x, -d.z);
        if (!segments.empty()) yaw += 2 * std::numbers::pi * std::round((segments.back() - yaw) / (2 * std::numbers::pi));
        segments.push_back(yaw);
    }
    for (size_t i = 0; i < points_.size(); ++i)
        yaws_.push_back((segments[i == 0 ? 0 : i - 1] + segments[std::min(i, segments.size() - 1)]) / 2);
}

Lane::Place Lane::at(double s) const {
    const size_t next = size_t(std::upper_bound(starts_.begin() + 1, starts_.end() - 1, s) - starts_.begin());
    const glm::dvec3 from = points_[next - 1], to = points_[next];
    const double length = starts_[next] - starts_[next - 1], t = (s - starts_[next - 1]) / length, turn = std::clamp(t, 0.0, 1.0);
    return {from + t * (to - from), yaws_[next - 1] + turn * (yaws_[next] - yaws_[next - 1]), std::atan2(to.y - from.y, length)};
}

Lane::Beside Lane::beside(glm::dvec2 point) const {
    Beside best;
    best.distance = std::numeric_limits<double>::infinity();
    for (size_t i = 1; i < points_.size(); ++i) {
        const glm::dvec2 from(points_[i - 1].x, points_[i - 1].z), to(points_[i].x, points_[i].z);
        const double length = starts_[i] - starts_[i - 1];
        const glm::dvec2 along = (to - from) / length, there = point - from;
        double t = glm::dot(there, along);
        if (i > 1) t = std::max(t, 0.0);
        if (i + 1 < points_.size()) t = std::min(t, length);
        const glm::dvec2 apart = there - t * along;
        const double distance = glm::length(apart);
        if (distance >= best.distance) continue;
        const double side = along.y * there.x - along.x * there.y;  // left of -Z is -X
        best = {starts_[i - 1] + t, std::copysign(distance, side), distance};
    }
    return best;
}

}  // namespace vesper
