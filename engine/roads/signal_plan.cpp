// Plans of traffic lights. SPDX-License-Identifier: MIT
#include "roads/signal_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <string_view>

#include "base/angle.h"
#include "base/budget.h"
#include "base/error.h"
#include "roads/road_mesh.h"
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
constexpr size_t kMostPairs = 4096;                    // of ways of two groups; more are taken to conflict

/// A traffic light.
struct Light {
    uint32_t road = 0, signal = 0;  ///< where it is in the file
    uint32_t for_road = 0;          ///< whose traffic it is for
    bool on_foot = false;
    double facing = 0;        ///< rad, of its traffic
    std::set<uint32_t> ways;  ///< connecting roads that it is for
};

/// Lights that are alike.
struct Group {
    std::vector<size_t> lights;
    std::set<uint32_t> ways;
    double facing = 0;  ///< rad, of the first light
    bool on_foot = false;
};

constexpr uint64_t kBytesOfWay = 48;  // a node of a set

void add_way(std::set<uint32_t>& ways, uint32_t way) {
    check_time();
    if (ways.insert(way).second) spend(kBytesOfWay);
}

double distance_between(glm::dvec3 p, const Segment& line) {
    const glm::dvec3 way = line.to - line.from;
    const double square = glm::dot(way, way);
    const double f = square > 0 ? std::clamp(glm::dot(p - line.from, way) / square, 0.0, 1.0) : 0;
    return glm::distance(p, line.from + way * f);
}

/// m, the least between points of two segments: at an end of one of them, or where both lines are nearest.
double distance_between(const Segment& a, const Segment& b) {
    const double ends = std::min({distance_between(a.from, b), distance_between(a.to, b), distance_between(b.from, a),
                                  distance_between(b.to, a)});
    const glm::dvec3 u = a.to - a.from, v = b.to - b.from, w = a.from - b.from;
    const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v), determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return ends;
    const double f = (uv * glm::dot(v, w) - vv * glm::dot(u, w)) / determinant,
                 g = (uu * glm::dot(v, w) - uv * glm::dot(u, w)) / determinant;
    const bool within = f >= 0 && f <= 1 && g >= 0 && g <= 1;
    return within ? std::min(ends, glm::length(w + u * f - v * g)) : ends;
}

/// rad, 0 to pi, between two directions.
double between(double a, double b) { return std::abs(std::remainder(a - b, 2 * kPi)); }

/// Numbers that are joined to sets; a set is known by its least number.
class Joined {
public:
    explicit Joined(size_t count) : head_(count) { std::iota(head_.begin(), head_.end(), size_t(0)); }
    size_t find(size_t i) {
        while (head_[i] != i) i = head_[i] = head_[head_[i]];
        return i;
    }
    void join(size_t i, size_t k) {
        const size_t a = find(i), b = find(k);
        head_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<size_t> head_;
};

class Planner {
public:
    Planner(const RoadNetwork& network, const LaneGraph& lanes) : network_(network), lanes_(lanes) {
        for (const SignalController& each : network.controllers)
            for (const std::string& id : each.signals) controllers_[id].insert(each.id);
        for (uint32_t j = 0; j < network.junctions.size(); ++j) {
            for (const std::string& id : network.junctions[j].controllers) junction_of_[id] = j;
            for (const JunctionConnection& each : network.junctions[j].connections) {
                // A road may begin and end at one junction, and its ways from either end cross.
                const uint32_t from = has_both_ends_at(each.incoming, j) ? kNoRoad : each.incoming;
                if (const auto [known, is_new] = incoming_.try_emplace(each.connecting, from); !is_new)
                    known->second = known->second == from ? from : kNoRoad;
            }
        }
        for (uint32_t r = 0; r < network.roads.size(); ++r)
            for (const std::string& id : network.roads[r].signal_references) references_[id].insert(r);
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

    bool has_both_ends_at(uint32_t road, uint32_t junction) const {
        if (road == kNoRoad) return false;
        const auto leads = [&](const RoadLink& link) {
            return link.to == RoadLink::To::Junction && link.index == junction;
        };
        return leads(network_.roads[road].predecessor) && leads(network_.roads[road].successor);
    }

    /// Adds a light; its junction, or the number of its road behind the junctions.
    uint32_t add(uint32_t r, uint32_t s) {
        const RoadSignal& signal = network_.roads[r].signals[s];
        const bool elsewhere = signal.counts_on != kNoRoad && !network_.roads[signal.counts_on].sections.empty();
        const uint32_t counts = elsewhere ? signal.counts_on : r;
        const Road& road = network_.roads[counts];
        const double at = elsewhere ? signal.counts_at : signal.s;
        Light light{.road = r, .signal = s, .for_road = counts, .on_foot = is_for_pedestrians(signal), .ways = {}};
        light.facing = reference_point(road, at).heading + (elsewhere ? 0 : signal.heading) +
                       (signal.orientation == '-' ? kPi : 0);
        uint32_t junction = road.junction;
        if (junction != kNoRoad) add_way(light.ways, counts);
        if (const auto found = references_.find(signal.id); found != references_.end())
            for (const uint32_t other : found->second)
                if (network_.roads[other].junction != kNoRoad) {
                    add_way(light.ways, other);
                    if (junction == kNoRoad) junction = network_.roads[other].junction;
                }
        const RoadLink& ahead = signal.orientation == '-' ? road.predecessor : road.successor;
        const double left = signal.orientation == '-' ? at : road.length - at;
        const bool before = road.junction == kNoRoad && ahead.to == RoadLink::To::Junction && left < kBeforeJunction;
        if (junction == kNoRoad && before) junction = ahead.index;
        if (const auto found = controllers_.find(signal.id); found != controllers_.end() && junction == kNoRoad)
            for (const std::string_view id : found->second)
                if (const auto known = junction_of_.find(id); known != junction_of_.end()) junction = known->second;
        if (junction == kNoRoad) junction = junction_near(network_.roads[r], signal);
        if (before && light.ways.empty() && junction == ahead.index)
            for (const JunctionConnection& each : network_.junctions[junction].connections)
                if (each.incoming == counts) add_way(light.ways, each.connecting);
        lights_.push_back(std::move(light));
        return junction != kNoRoad ? junction : static_cast<uint32_t>(network_.junctions.size()) + counts;
    }

    uint32_t junction_near(const Road& road, const RoadSignal& signal) const {
        const auto place = lanes_.nearest(network_.to_world(surface_point(road, signal.s, signal.t).position),
                                          kBeforeJunction / 2, [](const Lane& lane) { return lane.in_junction; });
        return place ? network_.roads[lanes_.lanes()[place->lane].road].junction : kNoRoad;
    }

    /// Joins lights for people on foot, lights of one controller, and lights of one road that face the same way.
    Joined alike(const std::vector<size_t>& members) const {
        Joined joined(members.size());
        std::optional<size_t> on_foot;
        std::map<std::string_view, size_t> of_controller;
        std::map<uint32_t, std::vector<size_t>> of_road;
        for (size_t i = 0; i < members.size(); ++i) {
            const Light& light = lights_[members[i]];
            if (light.on_foot) {
                joined.join(i, on_foot.value_or(i));
                on_foot = on_foot.value_or(i);
                continue;
            }
            of_road[light.for_road].push_back(i);
            if (const auto found = controllers_.find(signal_of(light).id); found != controllers_.end())
                for (const std::string_view id : found->second) {
                    check_time();
                    joined.join(i, of_controller.try_emplace(id, i).first->second);
                }
        }
        const auto facing = [&](size_t i) { return std::remainder(lights_[members[i]].facing, 2 * kPi); };
        for (auto& [road, of] : of_road) {
            // By direction, around the circle; those that face nearly as the first of them.
            std::sort(of.begin(), of.end(), [&](size_t a, size_t b) { return facing(a) < facing(b); });
            size_t first = of.front();
            for (const size_t i : of) {
                if (between(facing(first), facing(i)) >= kSameWay) first = i;
                joined.join(first, i);
            }
            if (between(facing(first), facing(of.front())) < kSameWay) joined.join(first, of.front());
        }
        return joined;
    }

    std::vector<Group> groups_of(const std::vector<size_t>& members) const {
        Joined joined = alike(members);
        std::vector<Group> groups;
        std::map<size_t, size_t> numbers;
        for (size_t i = 0; i < members.size(); ++i) {
            const auto [number, is_new] = numbers.try_emplace(joined.find(i), groups.size());
            const Light& light = lights_[members[i]];
            if (is_new) groups.push_back({.lights = {}, .ways = {}, .facing = light.facing, .on_foot = light.on_foot});
            Group& group = groups[number->second];
            group.lights.push_back(members[i]);
            for (const uint32_t way : light.ways) add_way(group.ways, way);
        }
        join_far_heads(groups);
        return groups;
    }

    /// Heads behind a junction, whose ways are not known, go with the group for cars that faces nearest to their way.
    static void join_far_heads(std::vector<Group>& groups) {
        const auto is_far = [](const Group& group) { return group.ways.empty() && !group.on_foot; };
        for (Group& far : groups) {
            if (!is_far(far)) continue;
            Group* nearest = nullptr;
            for (Group& group : groups) {
                check_time();
                if (group.on_foot || group.ways.empty() || between(far.facing, group.facing) >= kSameWay) continue;
                if (!nearest || between(far.facing, group.facing) < between(far.facing, nearest->facing))
                    nearest = &group;
            }
            if (!nearest) continue;
            nearest->lights.insert(nearest->lights.end(), far.lights.begin(), far.lights.end());
            far.lights.clear();
        }
        std::erase_if(groups, [](const Group& group) { return group.lights.empty(); });
    }

    bool ways_meet(uint32_t a, uint32_t b) {
        check_time();
        if (a == b) return true;
        // Ways from one road part, and its traffic does not cross itself.
        const auto from_a = incoming_.find(a), from_b = incoming_.find(b);
        if (from_a != incoming_.end() && from_b != incoming_.end() && from_a->second == from_b->second &&
            from_a->second != kNoRoad)
            return false;
        const auto [known, is_new] = meet_.try_emplace(std::minmax(a, b), false);
        if (!is_new) return known->second;
        spend(kBytesOfWay);
        for (const uint32_t i : lanes_of_[a])
            for (const uint32_t k : lanes_of_[b])
                if (!known->second) known->second = lanes_meet(lanes_.lanes()[i], lanes_.lanes()[k]);
        return known->second;
    }

    static bool lanes_meet(const Lane& a, const Lane& b) {
        for (size_t i = 0; i + 1 < a.poses.size(); ++i)
            for (size_t k = 0; k + 1 < b.poses.size(); ++k) {
                check_time();
                const Segment one{a.poses[i].position, a.poses[i + 1].position},
                    other{b.poses[k].position, b.poses[k + 1].position};
                if (distance_between(one, other) <= kApart) return true;
            }
        return false;
    }

    bool conflict(const Group& a, const Group& b) {
        if (a.on_foot || b.on_foot || a.ways.empty() || b.ways.empty()) return true;
        if (a.ways.size() * b.ways.size() > kMostPairs) return true;
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
    std::map<std::string, std::set<std::string_view>> controllers_;  // of signals
    std::map<std::string, uint32_t, std::less<>> junction_of_;       // of controllers
    std::map<std::string, std::set<uint32_t>> references_;           // roads, of signals
    std::map<uint32_t, uint32_t> incoming_;                          // roads, of connecting roads; kNoRoad: several
    std::map<uint32_t, std::vector<uint32_t>> lanes_of_;             // of roads
    std::map<std::pair<uint32_t, uint32_t>, bool> meet_;             // of connecting roads
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
