// Plans of traffic lights. SPDX-License-Identifier: MIT
#include "roads/signal_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "base/angle.h"
#include "base/budget.h"
#include "base/error.h"
#include "roads/road_surface.h"
#include "roads/sign_faces.h"

namespace vesper::roads {
namespace {

// RiLSA 2015: 3 s of amber at 50 km/h. A green of 20 s and 2 s of clearance are usual in towns.
constexpr double kGreen = 20, kAmber = 3, kClear = 2;  // s
constexpr double kOnFoot = 12;                         // s of green; the rest of their stage clears the road
constexpr double kStage = kGreen + kAmber + kClear;    // s
constexpr double kLatest = 1e6;                        // s
constexpr double kBeforeJunction = 60;                 // m from a light to the junction that it is for
constexpr double kSameWay = 0.6;                       // rad between directions of lights that face the same way
constexpr double kApart = 2.5;                         // m between the centres of ways that do not conflict
constexpr size_t kMostGroups = 64;                     // of a junction; more are one after another

/// A traffic light.
struct Light {
    uint32_t road = 0, signal = 0;
    bool on_foot = false;
    double facing = 0;        ///< rad, of its traffic
    std::set<uint32_t> ways;  ///< connecting roads that it is for
    size_t group = 0;
};

/// Lights that are alike.
struct Group {
    std::vector<size_t> lights;
    std::set<uint32_t> ways;
    bool on_foot = false;
};

class Planner {
public:
    Planner(const RoadNetwork& network, const LaneGraph& lanes) : network_(network), lanes_(lanes) {
        for (const SignalController& each : network.controllers)
            for (const std::string& id : each.signals) controllers_[id].push_back(&each.id);
        for (uint32_t j = 0; j < network.junctions.size(); ++j)
            for (const std::string& id : network.junctions[j].controllers) junction_of_[id] = j;
        for (uint32_t r = 0; r < network.roads.size(); ++r)
            for (const std::string& id : network.roads[r].signal_references) references_[id].push_back(r);
        for (uint32_t i = 0; i < lanes.lanes().size(); ++i)
            if (is_driven(lanes.lanes()[i].type)) lanes_of_[lanes.lanes()[i].road].push_back(i);
    }

    std::map<std::pair<uint32_t, uint32_t>, SignalPhase> phases() {
        // By junction; lights without one by road, after all junctions.
        std::map<uint32_t, std::vector<size_t>> sites;
        for (uint32_t r = 0; r < network_.roads.size(); ++r)
            for (uint32_t s = 0; s < network_.roads[r].signals.size() && !network_.roads[r].sections.empty(); ++s)
                if (is_traffic_light(network_.roads[r].signals[s])) sites[add(r, s)].push_back(lights_.size() - 1);
        std::map<std::pair<uint32_t, uint32_t>, SignalPhase> made;
        for (const auto& [site, members] : sites) plan(members, made);
        return made;
    }

private:
    const RoadSignal& signal_of(const Light& light) const { return network_.roads[light.road].signals[light.signal]; }

    /// Adds a light; its junction, or the number of its road behind the junctions.
    uint32_t add(uint32_t r, uint32_t s) {
        const Road& road = network_.roads[r];
        const RoadSignal& signal = road.signals[s];
        Light light{.road = r, .signal = s, .on_foot = is_for_pedestrians(signal), .ways = {}};
        light.facing = reference_point(road, signal.s).heading + signal.heading + (signal.orientation == '-' ? kPi : 0);
        uint32_t junction = road.junction;
        if (road.junction != kNoRoad) light.ways.insert(r);
        if (const auto found = references_.find(signal.id); found != references_.end())
            for (const uint32_t other : found->second)
                if (network_.roads[other].junction != kNoRoad) {
                    light.ways.insert(other);
                    if (junction == kNoRoad) junction = network_.roads[other].junction;
                }
        const RoadLink& ahead = signal.orientation == '-' ? road.predecessor : road.successor;
        const double left = signal.orientation == '-' ? signal.s : road.length - signal.s;
        const bool before = road.junction == kNoRoad && ahead.to == RoadLink::To::Junction && left < kBeforeJunction;
        if (junction == kNoRoad && before) junction = ahead.index;
        if (const auto found = controllers_.find(signal.id); found != controllers_.end() && junction == kNoRoad)
            for (const std::string* id : found->second)
                if (const auto known = junction_of_.find(*id); known != junction_of_.end()) junction = known->second;
        if (junction == kNoRoad) junction = junction_near(road, signal);
        if (before && light.ways.empty() && junction == ahead.index)
            for (const JunctionConnection& each : network_.junctions[junction].connections)
                if (each.incoming == r) light.ways.insert(each.connecting);
        lights_.push_back(std::move(light));
        return junction != kNoRoad ? junction : static_cast<uint32_t>(network_.junctions.size()) + r;
    }

    uint32_t junction_near(const Road& road, const RoadSignal& signal) const {
        const auto place = lanes_.nearest(network_.to_world(surface_point(road, signal.s, signal.t).position),
                                          kBeforeJunction / 2, [](const Lane& lane) { return lane.in_junction; });
        return place ? network_.roads[lanes_.lanes()[place->lane].road].junction : kNoRoad;
    }

    bool is_alike(const Light& a, const Light& b) const {
        if (a.on_foot != b.on_foot) return false;
        if (a.on_foot) return true;
        const auto one = controllers_.find(signal_of(a).id), other = controllers_.find(signal_of(b).id);
        if (one != controllers_.end() && other != controllers_.end())
            for (const std::string* id : one->second)
                if (std::find(other->second.begin(), other->second.end(), id) != other->second.end()) return true;
        // Lights of a road, and lights of an unknown road behind a junction, by the way they face.
        const bool same_road = a.road == b.road || a.ways.empty() || b.ways.empty();
        return same_road && std::abs(std::remainder(a.facing - b.facing, 2 * kPi)) < kSameWay;
    }

    std::vector<Group> groups_of(const std::vector<size_t>& members) {
        std::vector<size_t> head(members.size());
        std::iota(head.begin(), head.end(), size_t(0));
        const auto find = [&](size_t i) {
            while (head[i] != i) i = head[i] = head[head[i]];
            return i;
        };
        for (size_t i = 0; i < members.size(); ++i) {
            check_time();
            for (size_t k = 0; k < i; ++k)
                if (is_alike(lights_[members[i]], lights_[members[k]])) {
                    const size_t a = find(i), b = find(k);
                    head[std::max(a, b)] = std::min(a, b);
                }
        }
        std::vector<Group> groups;
        std::map<size_t, size_t> numbers;
        for (size_t i = 0; i < members.size(); ++i) {
            const auto [number, is_new] = numbers.try_emplace(find(i), groups.size());
            if (is_new) groups.emplace_back();
            Group& group = groups[number->second];
            const Light& light = lights_[members[i]];
            group.lights.push_back(members[i]);
            group.ways.insert(light.ways.begin(), light.ways.end());
            group.on_foot = light.on_foot;
        }
        return groups;
    }

    bool ways_meet(uint32_t a, uint32_t b) {
        if (a == b) return true;
        const auto [known, is_new] = meet_.try_emplace(std::minmax(a, b), false);
        if (!is_new) return known->second;
        for (const uint32_t i : lanes_of_[a])
            for (const uint32_t k : lanes_of_[b]) {
                check_time();
                for (const LanePose& p : lanes_.lanes()[i].poses) {
                    const Lane& other = lanes_.lanes()[k];
                    for (size_t n = 0; n + 1 < other.poses.size() && !known->second; ++n) {
                        const glm::dvec3 from = other.poses[n].position, way = other.poses[n + 1].position - from;
                        const double square = glm::dot(way, way);
                        const double f =
                            square > 0 ? std::clamp(glm::dot(p.position - from, way) / square, 0.0, 1.0) : 0;
                        known->second = glm::distance(p.position, from + way * f) < kApart;
                    }
                }
            }
        return known->second;
    }

    bool conflict(const Group& a, const Group& b) {
        if (a.on_foot || b.on_foot || a.ways.empty() || b.ways.empty()) return true;
        for (const uint32_t one : a.ways)
            for (const uint32_t other : b.ways)
                if (ways_meet(one, other)) return true;
        return false;
    }

    void plan(const std::vector<size_t>& members, std::map<std::pair<uint32_t, uint32_t>, SignalPhase>& made) {
        std::vector<Group> groups = groups_of(members);
        std::stable_partition(groups.begin(), groups.end(), [](const Group& group) { return !group.on_foot; });
        std::vector<std::vector<size_t>> stages;
        for (size_t g = 0; g < groups.size(); ++g) {
            size_t at = stages.size();
            for (size_t i = 0; i < stages.size() && at == stages.size() && groups.size() <= kMostGroups; ++i)
                if (std::none_of(stages[i].begin(), stages[i].end(),
                                 [&](size_t other) { return conflict(groups[g], groups[other]); }))
                    at = i;
            if (at == stages.size()) stages.emplace_back();
            stages[at].push_back(g);
        }
        // Cars wait first where they wait for people on foot, or for traffic without lights.
        const bool cars_alone = stages.size() == 1 && !groups[0].on_foot;
        if (cars_alone || stages.size() == 1) stages.emplace_back();
        if (cars_alone || (stages.size() == 2 && groups.back().on_foot && !groups[0].on_foot))
            std::swap(stages[0], stages[1]);
        const double cycle = kStage * static_cast<double>(stages.size());
        for (size_t i = 0; i < stages.size(); ++i)
            for (const size_t g : stages[i])
                for (const size_t light : groups[g].lights)
                    made[{lights_[light].road, lights_[light].signal}] = {cycle, kStage * static_cast<double>(i),
                                                                          groups[g].on_foot ? kOnFoot : kGreen,
                                                                          groups[g].on_foot ? 0 : kAmber};
    }

    const RoadNetwork& network_;
    const LaneGraph& lanes_;
    std::map<std::string, std::vector<const std::string*>> controllers_;  // of signals
    std::map<std::string, uint32_t> junction_of_;                         // of controllers
    std::map<std::string, std::vector<uint32_t>> references_;             // roads, of signals
    std::map<uint32_t, std::vector<uint32_t>> lanes_of_;                  // of roads
    std::map<std::pair<uint32_t, uint32_t>, bool> meet_;                  // of connecting roads
    std::vector<Light> lights_;
};

}  // namespace

void check_signal_time(double time) {
    if (!(time >= 0 && time <= kLatest))
        throw Error("traffic lights: the time of their plan must be from 0 to 1000000 s");
}

SignalAspect aspect_at(const SignalPhase& phase, double time) {
    const double cycles = time / phase.cycle, now = (cycles - std::floor(cycles)) * phase.cycle - phase.from;
    if (now < 0 || now >= phase.green + phase.amber) return SignalAspect::Red;
    return now < phase.green ? SignalAspect::Green : SignalAspect::Amber;
}

SignalAspect aspect_of(SignalState state, const SignalPhase& phase, double time, bool on_foot) {
    switch (state) {
        case SignalState::Plan:
            return aspect_at(phase, time);
        case SignalState::Red:
            return SignalAspect::Red;
        case SignalState::Amber:
            return on_foot ? SignalAspect::Red : SignalAspect::Amber;
        case SignalState::Green:
            return SignalAspect::Green;
        case SignalState::Off:
            break;
    }
    return SignalAspect::Off;
}

SignalPlan::SignalPlan(const RoadNetwork& network, const LaneGraph& lanes)
    : phases_(Planner(network, lanes).phases()) {}

SignalPhase SignalPlan::of(uint32_t road, uint32_t signal) const {
    const auto found = phases_.find({road, signal});
    return found == phases_.end() ? SignalPhase{} : found->second;
}

}  // namespace vesper::roads
