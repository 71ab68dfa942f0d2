#include "external/external_places.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "base/angle.h"
#include "traffic/daylight.h"

namespace vesper::drive {
namespace {

constexpr double kHalfPi = std::numbers::pi / 2;

traffic::Actor actor_of(const osi::ObjectNow& now, const MessageFrame& frame) {
    const osi::MovingObject& o = now.object;
    const double height = ExternalBodies::size_of(o).z;
    return {.position = frame.point(o.centre - height / 2 * osi::axes_of(o.yaw, o.pitch, o.roll)[2]),
            .yaw = o.yaw + frame.yaw - kHalfPi,
            .pitch = -o.pitch,
            .roll = o.roll,
            .speed = now.speed,
            .lamps = lamps_of(o.lights, now.flashes_for)};
}

bool is_person(osi::MovingObject::Kind kind) {
    return kind == osi::MovingObject::Kind::Pedestrian || kind == osi::MovingObject::Kind::Animal;
}

}  // namespace

ExternalPlaces::ExternalPlaces(const ExternalBodies& bodies, const std::vector<SignalLens>& lenses,
                               const MessageFrame& frame, std::string host, HeightJudge judge)
    : bodies_(&bodies), lenses_(&lenses), frame_(frame), host_(std::move(host)), judge_(std::move(judge)) {
    for (size_t i = 0; i < bodies.all().size(); ++i) free_[bodies.all()[i].kind].insert(i);
}

void ExternalPlaces::give_back(const Taken& taken) { free_[bodies_->all()[taken.body].kind].insert(taken.body); }

std::optional<size_t> ExternalPlaces::body_of(const osi::MovingObject& object) {
    if (const auto taken = taken_.find(object.id); taken != taken_.end()) {
        if (taken->second.kind == object.kind && taken->second.model == object.model) return taken->second.body;
        give_back(taken->second);
        taken_.erase(taken);
    }
    std::set<size_t>& free = free_[bodies_->kind_of(object)];
    if (free.empty()) return std::nullopt;
    const size_t body = *free.begin();
    free.erase(free.begin());
    taken_.emplace(object.id, Taken{body, object.kind, object.model});
    return body;
}

ExternalState ExternalPlaces::place(const osi::Moment& moment) {
    ExternalState made;
    made.sun_elevation = sun_elevation_of(moment.environment);
    std::set<uint64_t> here;
    for (const osi::ObjectNow& now : moment.objects) here.insert(now.object.id);
    for (auto taken = taken_.begin(); taken != taken_.end();) {
        if (!here.contains(taken->first)) {
            give_back(taken->second);
            taken = taken_.erase(taken);
        } else {
            ++taken;
        }
    }
    const bool at_ground = judge_.take(moment, frame_);
    for (osi::ObjectNow now : moment.objects) {
        osi::MovingObject& object = now.object;
        if (at_ground) raise(object);
        if (here.erase(object.id) == 0) continue;  // of two with one id the first counts
        traffic::Actor actor = actor_of(now, frame_);
        const bool is_host = host_.empty() ? moment.host == object.id : host_ == std::to_string(object.id);
        if (is_host && !made.driver) {
            made.driver = actor, made.host = object.id, made.objects.push_back(object);
            continue;
        }
        const auto body = body_of(object);
        if (!body) {
            ++made.without_body;
            continue;
        }
        const glm::dvec3 size = ExternalBodies::size_of(object), own = bodies_->all()[*body].size;
        if (own.x > 0) actor.scale = size / own;
        made.objects.push_back(object);
        made.actors.push_back({.index = *body,
                               .actor = std::move(actor),
                               .length = size.x,
                               .width = size.y,
                               .person = is_person(object.kind)});
    }
    if (moment.traffic_lights.empty()) return made;
    std::map<uint32_t, bool> lit;
    std::set<std::string> signals;
    for (const osi::TrafficLightNow& now : moment.traffic_lights) {
        const uint32_t lens = finder_.find(*lenses_, now.light, frame_.point(now.light.position));
        if (lens == scene::kNone || now.light.state == osi::LampState::Unknown) continue;
        lit[lens] = osi::is_lit(now.light.state, now.state_for, kSignalPeriod);
        if (!(*lenses_)[lens].signal.empty()) signals.insert((*lenses_)[lens].signal);
    }
    // Of a signal that is spoken of, lenses that are not are dark.
    for (uint32_t i = 0; i < lenses_->size(); ++i) {
        const SignalLens& lens = (*lenses_)[i];
        const auto said = lit.find(i);
        made.lenses.push_back(said != lit.end() ? said->second : lens.otherwise && !signals.contains(lens.signal));
    }
    return made;
}

std::optional<double> sun_elevation_of(const osi::Environment& e) {
    if (e.sun_elevation) return std::clamp(*e.sun_elevation * kDegreesPerRadian, -90.0, 90.0);
    if (e.time_of_day)
        return std::asin(-std::cos(std::numbers::pi / 4) * std::cos(2 * std::numbers::pi * *e.time_of_day / 86400)) *
               kDegreesPerRadian;
    if (e.ambient_level == 0) return std::nullopt;
    constexpr double kBounds[]{0.001, 0.01, 1, 3, 10, 20, 400, 1000, 10'000, 120'000};  // lx
    const double wanted = std::sqrt(kBounds[e.ambient_level - 1] * kBounds[e.ambient_level]);
    double low = -90, high = 90;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (traffic::kOvercast * traffic::daylight_illuminance(middle) < wanted ? low : high) = middle;
    }
    return low;
}

osi::LightStates light_states_of(const traffic::VehicleLamps& lamps) {
    const auto state = [](bool on) { return on ? osi::LampState::On : osi::LampState::Off; };
    const auto flashes = [&](traffic::Indicator side) {
        return lamps.indicator == side || lamps.indicator == traffic::Indicator::Both ? osi::LampState::Flashing
                                                                                      : osi::LampState::Off;
    };
    return {.low = state(lamps.low),
            .high = state(lamps.high),
            .tail = state(lamps.tail),
            .brake = state(lamps.brake),
            .left = flashes(traffic::Indicator::Left),
            .right = flashes(traffic::Indicator::Right),
            .front_fog = state(lamps.front_fog),
            .rear_fog = state(lamps.rear_fog),
            .reversing = state(lamps.reversing)};
}

traffic::VehicleLamps lamps_of(const osi::LightStates& states, double for_seconds) {
    const auto lit = [&](osi::LampState state) { return osi::is_lit(state, for_seconds, traffic::kFlashPeriod); };
    const bool left = states.left == osi::LampState::Flashing, right = states.right == osi::LampState::Flashing;
    return {.low = lit(states.low),
            .high = lit(states.high),
            .tail = lit(states.tail),
            .brake = lit(states.brake),
            .left = lit(states.left),
            .right = lit(states.right),
            .front_fog = lit(states.front_fog),
            .rear_fog = lit(states.rear_fog),
            .reversing = lit(states.reversing),
            .indicator = left && right ? traffic::Indicator::Both
                         : left        ? traffic::Indicator::Left
                         : right       ? traffic::Indicator::Right
                                       : traffic::Indicator::None};
}

}  // namespace vesper::drive
