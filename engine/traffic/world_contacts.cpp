// What the driver's car meets. SPDX-License-Identifier: MIT
#include "traffic/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vesper::traffic {
namespace {

constexpr double kSameContact = 0.5;                   // s without touching, after which it is another contact
constexpr double kPersonMass = 75, kPersonSize = 0.5;  // kg, m

}  // namespace

// The impulse on the car, N s.
glm::dvec2 World::meet(size_t who, const std::string& node, const GroundBox& other, double height,
                       const Opponent& opponent, bool person) {
    const VehicleParameters& p = description_->vehicle;
    const GroundBox mine = ground_box(driver_, p);
    const glm::dvec2 apart = mine.centre - other.centre;
    const double reach = mine.length + mine.width + other.length + other.width;
    if (glm::dot(apart, apart) > reach * reach / 4) return {0, 0};
    const auto touching = overlap(mine, other);
    if (!touching || std::abs(ground().position.y - height) > kLevels) return {0, 0};
    const bool begins = seconds_ - std::exchange(touched_at_[who], seconds_) > kSameContact;
    if (person && !begins) return {0, 0};
    const glm::dvec2 arm = touching->point - driver_.position;
    const double closing = glm::dot(opponent.velocity - velocity_at(driver_, arm), touching->normal);
    const glm::dvec2 impulse = strike(driver_, p, arm, touching->normal, opponent);
    if (begins) contacts_.push_back({seconds_, node, std::max(closing, 0.0), glm::length(impulse)});
    if (!person) driver_.position += touching->depth * touching->normal;
    return impulse;
}

void World::meet_others(const VehicleState& before) {
    const WorldDescription& d = *description_;
    const glm::dvec2 was = driver_.position;
    const auto plan = [](glm::dvec3 at) { return glm::dvec2(at.x, at.z); };
    for (size_t i = 0; i < cars_.size(); ++i) {
        const Course::Place at = place_of(i);
        const GroundBox other{plan(at.position), at.yaw, d.cars[i].length, d.cars[i].width};
        const glm::dvec2 heading = other.forward();
        const glm::dvec2 impulse = meet(i, d.cars[i].node, other, at.position.y,
                                        {cars_[i].speed * heading, heading, 1 / d.vehicle.mass, 0}, false);
        cars_[i].speed = std::max(0.0, cars_[i].speed - glm::dot(impulse, heading) / d.vehicle.mass);
    }
    for (size_t i = 0; i < walks_.size(); ++i) {
        Walk& walk = walks_[i];
        if (walk.fallen) continue;
        const Course::Place at = (walk.back ? back_ : d.paths)[d.walkers[i].path].at(walk.s);
        const GroundBox other{plan(at.position), at.yaw, kPersonSize, kPersonSize};
        const size_t known = contacts_.size();
        meet(cars_.size() + i, d.walkers[i].node, other, at.position.y,
             {walk.speed * other.forward(), other.forward(), 1 / kPersonMass, 1 / kPersonMass}, true);
        walk.fallen = contacts_.size() > known;
    }
    for (const ExternalActor& external : external_actors_) {
        const Actor& a = external.actor;
        const GroundBox other{plan(a.position), a.yaw, external.length, external.width};
        const glm::dvec2 heading = other.forward();
        const double gives = external.person ? 1 / kPersonMass : 0;
        meet(cars_.size() + walks_.size() + external.index, d.external_nodes[external.index], other, a.position.y,
             {a.speed * heading, heading, gives, gives}, external.person);
    }
    // Nobody is pushed over a kerb.
    if (driver_.position != was) touched_ |= collide(driver_, before, d.vehicle, d.barriers, ground().position.y);
}

}  // namespace vesper::traffic
