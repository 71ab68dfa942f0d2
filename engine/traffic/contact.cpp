#include "traffic/contact.h"

#include <algorithm>
#include <cmath>

namespace vesper::traffic {
namespace {

using glm::dvec2;

}  // namespace

dvec2 GroundBox::forward() const { return {-std::sin(yaw), -std::cos(yaw)}; }

std::array<dvec2, 4> GroundBox::corners() const {
    const dvec2 ahead = length / 2 * forward(), side = width / 2 * dvec2(-std::cos(yaw), std::sin(yaw));
    return {centre + ahead + side, centre + ahead - side, centre - ahead + side, centre - ahead - side};
}

bool GroundBox::contains(dvec2 point) const {
    const dvec2 to = point - centre, ahead = forward();
    return std::abs(glm::dot(to, ahead)) <= length / 2 && std::abs(to.x * ahead.y - to.y * ahead.x) <= width / 2;
}

GroundBox ground_box(const VehicleState& s, const VehicleParameters& p) {
    return {s.position + (p.front_axle - p.rear_axle) / 2 * s.forward(), s.yaw, p.length, p.width};
}

std::optional<Overlap> overlap(const GroundBox& a, const GroundBox& b) {
    const dvec2 apart = a.centre - b.centre;
    Overlap best;
    best.depth = INFINITY;
    for (const dvec2 ahead : {a.forward(), b.forward()})
        for (dvec2 axis : {ahead, dvec2(-ahead.y, ahead.x)}) {
            const auto reach = [&](const GroundBox& f) {
                const double along = std::abs(glm::dot(f.forward(), axis));
                return (f.length * along + f.width * std::sqrt(std::max(0.0, 1 - along * along))) / 2;
            };
            const double distance = glm::dot(apart, axis), depth = reach(a) + reach(b) - std::abs(distance);
            if (depth <= 0) return std::nullopt;
            if (distance < 0) axis = -axis;
            if (depth < best.depth) best.depth = depth, best.normal = axis;
        }
    dvec2 sum(0);
    double inside = 0;
    for (const dvec2 corner : a.corners())
        if (b.contains(corner)) sum += corner, ++inside;
    for (const dvec2 corner : b.corners())
        if (a.contains(corner)) sum += corner, ++inside;
    best.point = inside > 0 ? sum / inside : (a.centre + b.centre) / 2.0;  // crossed: no corner in the other
    return best;
}

double Opponent::give(dvec2 direction) const {
    const double part = glm::dot(direction, heading);
    return along * part * part + across * (1 - part * part);
}

// A turn to the left, seen from above, takes (x, z) to (z, -x).
dvec2 velocity_at(const VehicleState& s, dvec2 arm) { return s.velocity() + s.yaw_rate * dvec2(arm.y, -arm.x); }

dvec2 strike(VehicleState& s, const VehicleParameters& p, dvec2 arm, dvec2 normal, const Opponent& other) {
    dvec2 given(0);  // to the other
    const auto lever = [&](dvec2 direction) { return arm.y * direction.x - arm.x * direction.y; };
    const auto relative = [&] {
        const dvec2 gives(glm::dot(given, other.heading), other.heading.x * given.y - other.heading.y * given.x);
        return velocity_at(s, arm) - (other.velocity + other.along * gives.x * other.heading +
                                      other.across * gives.y * dvec2(-other.heading.y, other.heading.x));
    };
    const auto push = [&](dvec2 direction, double impulse) {
        const dvec2 changed = s.velocity() + impulse / p.mass * direction;
        s.speed = glm::dot(changed, s.forward()), s.lateral = glm::dot(changed, s.left());
        s.yaw_rate += impulse * lever(direction) / p.yaw_inertia;
        given -= impulse * direction;
    };
    const auto inertia = [&](dvec2 direction) {
        return 1 / (1 / p.mass + lever(direction) * lever(direction) / p.yaw_inertia + other.give(direction));
    };
    const double into = -glm::dot(relative(), normal);
    if (into <= 0) return {0, 0};
    const double blow = into * inertia(normal);
    push(normal, blow);
    const dvec2 along(-normal.y, normal.x);
    const double sliding = glm::dot(relative(), along), stop = std::abs(sliding) * inertia(along);
    push(along, -std::copysign(std::min(kScrape * blow, stop), sliding));
    return -given;
}

}  // namespace vesper::traffic
