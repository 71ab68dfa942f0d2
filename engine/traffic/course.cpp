#include "traffic/course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"

namespace vesper::traffic {

namespace {

constexpr double kOutlook = 0.5;  // s ahead, of the speed to have

}  // namespace

Course::Course(std::string name, std::vector<glm::dvec3> points, double width, double speed, bool closed)
    : Course(std::move(name), points, width, std::vector<double>(points.size(), speed), closed) {}

Course::Course(std::string name, std::vector<glm::dvec3> points, double width, const std::vector<double>& limits,
               bool closed)
    : name_(std::move(name)),
      points_(std::move(points)),
      width_(width),
      speed_(limits.empty() ? 0 : limits.front()),
      closed_(closed) {
    if (points_.size() < 2) throw Error("lane " + name_ + ": at least two points are needed");
    if (limits.size() != points_.size())
        throw Error("lane " + name_ + ": " + std::to_string(limits.size()) + " limits of " +
                    std::to_string(points_.size()) + " points");
    if (closed_) points_.push_back(points_.front());
    starts_.push_back(0);
    std::vector<double> segments;  // yaw of each
    for (size_t i = 1; i < points_.size(); ++i) {
        const glm::dvec3 d = points_[i] - points_[i - 1];
        const double length = std::hypot(d.x, d.z);
        if (!(length > 1e-6))
            throw Error("lane " + name_ + ": points " + std::to_string(i - 1) + " and " + std::to_string(i) +
                        " are the same");
        starts_.push_back(starts_.back() + length);
        double yaw = std::atan2(-d.x, -d.z);
        if (!segments.empty())
            yaw += 2 * std::numbers::pi * std::round((segments.back() - yaw) / (2 * std::numbers::pi));
        segments.push_back(yaw);
    }
    for (size_t i = 0; i < points_.size(); ++i)
        yaws_.push_back((segments[i == 0 ? 0 : i - 1] + segments[std::min(i, segments.size() - 1)]) / 2);
    if (closed_) {
        // Once round is whole turns, and half the bend where it closes belongs to either end.
        const double turns =
            std::round((segments.back() - segments.front()) / (2 * std::numbers::pi)) * 2 * std::numbers::pi;
        const double bend = (segments.front() + turns - segments.back()) / 2;
        yaws_.front() -= bend, yaws_.back() += bend;
    }

    // Where the limit changes the lower one holds; between two points the higher of theirs does.
    const size_t last = limits.size() - 1;
    for (size_t i = 0; i < points_.size(); ++i) {
        const double before = i > 0 ? limits[i - 1] : limits[closed_ ? last : 0];
        speeds_.push_back(std::min(before, i <= last ? limits[i] : limits[0]));
    }
    for (size_t i = 1; i + 1 < points_.size(); ++i) {
        const double curvature = std::abs(segments[i] - segments[i - 1]) / ((starts_[i + 1] - starts_[i - 1]) / 2);
        if (curvature > 1e-9) speeds_[i] = std::min(speeds_[i], std::sqrt(kCurve / curvature));
    }
    for (int round = 0; round < (closed_ ? 2 : 1); ++round) {
        if (closed_) speeds_.back() = std::min(speeds_.back(), speeds_.front());
        for (size_t i = points_.size() - 1; i-- > 0;)
            speeds_[i] = std::min(
                speeds_[i], std::sqrt(speeds_[i + 1] * speeds_[i + 1] + 2 * kEase * (starts_[i + 1] - starts_[i])));
    }
}

double Course::wrapped(double s) const { return closed_ ? s - length() * std::floor(s / length()) : s; }

size_t Course::next_point(double s) const {
    return size_t(std::upper_bound(starts_.begin() + 1, starts_.end() - 1, s) - starts_.begin());
}

double Course::ahead(double from, double to) const { return closed_ ? wrapped(to - from) : to - from; }

double Course::speed_at(double s) const {
    s = wrapped(s);
    const size_t next = next_point(s);
    const double rest = std::max(starts_[next] - s, 0.0);
    return std::min(std::max(speeds_[next - 1], speeds_[next]),
                    std::sqrt(speeds_[next] * speeds_[next] + 2 * kEase * rest));
}

Course::Place Course::at(double s) const {
    s = wrapped(s);
    const size_t next = next_point(s);
    const glm::dvec3 from = points_[next - 1], to = points_[next];
    const double length = starts_[next] - starts_[next - 1], t = (s - starts_[next - 1]) / length,
                 turn = std::clamp(t, 0.0, 1.0);
    return {from + t * (to - from), yaws_[next - 1] + turn * (yaws_[next] - yaws_[next - 1]),
            std::atan2(to.y - from.y, length)};
}

Course::Beside Course::beside(glm::dvec2 point) const {
    Beside best;
    best.distance = std::numeric_limits<double>::infinity();
    for (size_t i = 1; i < points_.size(); ++i) {
        const glm::dvec2 from(points_[i - 1].x, points_[i - 1].z), to(points_[i].x, points_[i].z);
        const double length = starts_[i] - starts_[i - 1];
        const glm::dvec2 along = (to - from) / length, there = point - from;
        double t = glm::dot(there, along);
        if (i > 1 || closed_) t = std::max(t, 0.0);
        if (i + 1 < points_.size() || closed_) t = std::min(t, length);
        const glm::dvec2 apart = there - t * along;
        const double distance = glm::length(apart);
        if (distance >= best.distance) continue;
        const double side = along.y * there.x - along.x * there.y;  // left of -Z is -X
        best = {starts_[i - 1] + t, std::copysign(distance, side), distance};
    }
    return best;
}

double follow_lane(const Course& lane, CarFollowing following, double s, double speed_factor, double speed, double gap,
                   double closing) {
    following.speed = lane.speed_at(s) * speed_factor;
    const double next = lane.speed_at(s + std::max(speed, 0.0) * kOutlook) * speed_factor,
                 free = idm_acceleration(following, speed, gap, closing);
    return next < following.speed ? std::min(free, std::max((next - speed) / kOutlook, -following.hardest)) : free;
}

}  // namespace vesper::traffic
