#include "osi/timeline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/angle.h"

namespace vesper::osi {
namespace {

constexpr double kBrakeLampDeceleration = 0.7;          // m/s^2, UN Regulation 13-H: from 0.7 on they may come on
constexpr double kStanding = 0.05, kMoving = 1;         // m/s
constexpr uint64_t kMostWaiting = uint64_t{256} << 20;  // bytes
constexpr double kSmoothing = 0.25;                     // s over which a change of speed is looked at
constexpr double kSame = 1e-6;                          // s: times of messages are rounded

constexpr std::array kLamps{&LightStates::low,       &LightStates::high,     &LightStates::tail,
                            &LightStates::brake,     &LightStates::left,     &LightStates::right,
                            &LightStates::front_fog, &LightStates::rear_fog, &LightStates::reversing};

bool has_lamps(const MovingObject& object) {
    using Kind = MovingObject::Kind;
    return object.kind == Kind::Car || object.kind == Kind::Truck || object.kind == Kind::Bus ||
           object.kind == Kind::Motorcycle;
}

glm::dvec3 ahead_of(const MovingObject& o) { return axes_of(o.yaw, o.pitch, o.roll)[0]; }

LampState on_if(bool on) { return on ? LampState::On : LampState::Off; }

}  // namespace

double Timeline::seconds_of(const Message& message) const { return double(message.nanoseconds - *start_) / 1e9; }

Timeline::Added Timeline::add(Message message) {
    if (!start_) start_ = message.nanoseconds;
    const auto place = std::upper_bound(messages_.begin(), messages_.end(), message.nanoseconds,
                                        [](int64_t t, const Message& m) { return t < m.nanoseconds; });
    if (place != messages_.begin() && place[-1].nanoseconds == message.nanoseconds) return Added::Repeated;
    if (message.nanoseconds < *start_ || size_t(place - messages_.begin()) < used_) return Added::Late;
    const uint64_t bytes = memory_of(message);
    if (!keeps_ && bytes_ + bytes > kMostWaiting) return Added::CrowdedOut;
    bytes_ += bytes;
    messages_.insert(place, std::move(message));
    return Added::Accepted;
}

void Timeline::use(size_t index) {
    if (index < used_) return;
    used_ = index + 1;
    if (on_use) on_use(messages_[index]);
}

void Timeline::follow(const MovingObject& object, double time, const Track* before, Track& now) const {
    now.time = time, now.centre = object.centre, now.stated = object.lights;
    if (object.velocity)
        now.speed = glm::dot(*object.velocity, ahead_of(object));
    else if (before)
        now.speed = glm::dot(object.centre - before->centre, ahead_of(object)) / (time - before->time);
    now.moved = (before && before->moved) || std::abs(now.speed) > kMoving;
    if (before) {
        const double span = time - before->time, weight = 1 - std::exp(-span / kSmoothing);
        now.acceleration = before->acceleration +
                           weight * ((std::abs(now.speed) - std::abs(before->speed)) / span - before->acceleration);
    }
    LightStates& s = now.shown = object.lights;
    const bool lamps = has_lamps(object), standing = std::abs(now.speed) < kStanding;
    const auto otherwise = [&](LampState LightStates::*lamp, bool on) {
        if (s.*lamp == LampState::Unknown) s.*lamp = on_if(lamps && on);
    };
    otherwise(&LightStates::low, true);
    otherwise(&LightStates::high, false);
    otherwise(&LightStates::rear_fog, false);
    otherwise(&LightStates::tail, s.low != LampState::Off || s.high != LampState::Off || s.rear_fog != LampState::Off);
    otherwise(&LightStates::brake, now.acceleration < -kBrakeLampDeceleration || (now.moved && standing));
    otherwise(&LightStates::reversing, now.speed < -kStanding);
    for (const auto lamp : kLamps) otherwise(lamp, false);
    now.flashing_since = before ? before->flashing_since : time;
    for (const auto lamp : kLamps)
        if (s.*lamp == LampState::Flashing && (!before || before->shown.*lamp != LampState::Flashing))
            now.flashing_since = time;
}

void Timeline::pass(const Message& message) {
    const double time = seconds_of(message);
    if (message.host) host_ = message.host;
    if (message.environment) environment_ = *message.environment;
    for (const TrafficLight& light : message.traffic_lights) {
        const auto held = lights_.find(light.id);
        if (held != lights_.end())
            held->second = {light, held->second.light.state == light.state ? held->second.since : time};
        else if (lights_.size() < size_t(kMostObjects))
            lights_.emplace(light.id, Held{light, time});
    }
    std::unordered_map<uint64_t, Track> tracks;
    for (const MovingObject& object : message.objects) {
        if (tracks.contains(object.id)) continue;  // of two with one id the first counts
        const auto before = tracks_.find(object.id);
        follow(object, time, before == tracks_.end() ? nullptr : &before->second, tracks[object.id]);
    }
    tracks_ = std::move(tracks);
}

void Timeline::forget() { passed_ = 0, host_.reset(), tracks_.clear(), lights_.clear(), environment_ = {}; }

Moment Timeline::at(double seconds) {
    if (messages_.empty()) return {};
    if (keeps_ && passed_ > 0 && seconds_of(messages_[passed_ - 1]) > seconds + kSame) forget();
    while (passed_ < messages_.size() && seconds_of(messages_[passed_]) <= seconds + kSame) {
        use(passed_);
        pass(messages_[passed_]);
        ++passed_;
        if (keeps_ || passed_ < 2) continue;
        bytes_ -= memory_of(messages_.front());
        messages_.pop_front();
        --passed_, --used_;
    }
    if (passed_ == 0) return {};
    const Message& from = messages_[passed_ - 1];
    const Message* to = passed_ < messages_.size() ? &messages_[passed_] : nullptr;
    std::unordered_map<uint64_t, const MovingObject*> later;
    if (to) {
        use(passed_);
        for (const MovingObject& object : to->objects) later.emplace(object.id, &object);
    }
    const double time = seconds_of(from), f = to ? std::max(0.0, (seconds - time) / (seconds_of(*to) - time)) : 0;
    Moment moment{.host = host_, .environment = environment_};
    for (const MovingObject& object : from.objects) {
        const Track& track = tracks_.at(object.id);
        ObjectNow now{object, track.speed, seconds - track.flashing_since};
        now.object.lights = track.shown;
        if (const auto next = later.find(object.id); next != later.end()) {
            const MovingObject& o = *next->second;
            now.object.centre = glm::mix(object.centre, o.centre, f);
            now.object.yaw = mix_angles(object.yaw, o.yaw, f), now.object.pitch = mix_angles(object.pitch, o.pitch, f);
            now.object.roll = mix_angles(object.roll, o.roll, f);
            if (object.velocity && o.velocity) now.speed = glm::mix(track.speed, glm::dot(*o.velocity, ahead_of(o)), f);
        }
        moment.objects.push_back(std::move(now));
    }
    for (const auto& [id, held] : lights_) moment.traffic_lights.push_back({held.light, seconds - held.since});
    return moment;
}

bool is_lit(LampState state, double since, double period) {
    return state == LampState::On ||
           (state == LampState::Flashing && std::fmod(std::max(since, 0.0), period) < period / 2);
}

}  // namespace vesper::osi
