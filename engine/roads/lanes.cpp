// Questions to the graph of lanes. SPDX-License-Identifier: MIT
#include "roads/lanes.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "roads/lane_build.h"

namespace vesper::roads {
namespace {

constexpr double kTown = 50 / 3.6, kFree = 130 / 3.6;  // m/s

constexpr size_t kMaxWaySteps = 1'000'000;  // ahead on one way: beyond that the longest of the next lanes is taken

glm::dvec2 from_above(glm::dvec3 p) { return {p.x, p.z}; }

/// The nearest point of a segment, as a fraction of it.
double fraction_near(glm::dvec3 a, glm::dvec3 b, glm::dvec3 p) {
    const glm::dvec3 along = b - a;
    const double length = glm::dot(along, along);
    return length > 0 ? std::clamp(glm::dot(p - a, along) / length, 0.0, 1.0) : 0;
}

double turn_between(const Lane& lane, const Lane& next) {
    return std::acos(std::clamp(glm::dot(lane.poses.back().forward, next.poses.back().forward), -1.0, 1.0));
}

}  // namespace

double allowed_speed(const Lane& lane, const LanePose& pose, double before) {
    if (pose.speed_limit > 0) return std::min(pose.speed_limit, kFree);
    return lane.in_junction && before > 0 ? before : kTown;
}

LaneGraph::LaneGraph(const RoadNetwork& network) : lanes_(build_lanes(network)), kerbs_(build_kerbs(network)) {
    link_where_they_meet(lanes_);
    for (uint32_t lane = 0; lane < lanes_.size(); ++lane)
        for (uint32_t i = 0; i + 1 < lanes_[lane].poses.size(); ++i) {
            lane_grid_.add(from_above(lanes_[lane].poses[i].position), from_above(lanes_[lane].poses[i + 1].position));
            lane_segments_.emplace_back(lane, i);
        }
    for (const Kerb& kerb : kerbs_) kerb_grid_.add(from_above(kerb.from), from_above(kerb.to));
}

LanePose LaneGraph::pose(uint32_t index, double along) const {
    const Lane& lane = lanes_[index];
    const auto after = std::upper_bound(lane.along.begin() + 1, lane.along.end() - 1, along);
    const auto i = static_cast<size_t>(after - lane.along.begin());
    const LanePose &a = lane.poses[i - 1], &b = lane.poses[i];
    const double within = std::clamp(along, 0.0, lane.length), span = lane.along[i] - lane.along[i - 1];
    const double f = (within - lane.along[i - 1]) / span;
    LanePose pose;
    // Hermite: position and direction are continuous, and the curve passes its points in their directions.
    const double f2 = f * f, f3 = f2 * f;
    pose.position = a.position * (2 * f3 - 3 * f2 + 1) + b.position * (3 * f2 - 2 * f3) +
                    (a.forward * (f3 - 2 * f2 + f) + b.forward * (f3 - f2)) * span;
    pose.forward = glm::normalize(glm::mix(a.forward, b.forward, f));
    const glm::dvec3 up = glm::mix(a.up, b.up, f);
    pose.up = glm::normalize(up - pose.forward * glm::dot(up, pose.forward));
    pose.width = glm::mix(a.width, b.width, f);
    pose.curvature = glm::mix(a.curvature, b.curvature, f);
    pose.speed_limit = a.speed_limit;
    pose.position += pose.forward * (along - within);
    return pose;
}

LanePose LaneGraph::pose_beside(uint32_t lane, double along, double offset) const {
    LanePose found = pose(lane, along);
    found.position += found.left() * offset;
    return found;
}

std::optional<LanePlace> LaneGraph::cheapest(glm::dvec3 point, double reach, const Cost& cost) const {
    std::optional<LanePlace> best;
    double least = INFINITY;
    for (const uint32_t number : lane_grid_.near(from_above(point), reach)) {
        const auto [index, i] = lane_segments_[number];
        const Lane& lane = lanes_[index];
        const glm::dvec3 a = lane.poses[i].position, b = lane.poses[i + 1].position;
        const double f = fraction_near(a, b, point), distance = glm::distance(point, a + (b - a) * f);
        if (distance > reach || distance >= least) continue;
        const double costs = distance + cost(lane, lane.poses[i]);
        if (!(costs < least)) continue;
        least = costs;
        best = LanePlace{index, lane.along[i] + (lane.along[i + 1] - lane.along[i]) * f, 0, distance};
    }
    if (best) {
        const LanePose at = pose(best->lane, best->along);
        best->offset = glm::dot(point - at.position, at.left());
    }
    return best;
}

std::optional<LanePlace> LaneGraph::nearest(glm::dvec3 point, double reach,
                                            const std::function<bool(const Lane&)>& wanted) const {
    return cheapest(point, reach, [&](const Lane& lane, const LanePose&) {
        return (wanted ? wanted(lane) : is_driven(lane.type)) ? 0.0 : INFINITY;
    });
}

std::optional<LanePlace> LaneGraph::nearest_along(glm::dvec3 point, glm::dvec3 forward, double reach) const {
    const glm::dvec3 wanted = glm::normalize(forward);
    return cheapest(point, reach, [&](const Lane& lane, const LanePose& pose) {
        return is_driven(lane.type) ? 2 * (1 - glm::dot(wanted, pose.forward)) : INFINITY;
    });
}

std::vector<uint32_t> LaneGraph::route(uint32_t from, uint32_t to) const {
    std::vector<double> cost(lanes_.size(), INFINITY);
    std::vector<uint32_t> before(lanes_.size(), kNoLane);
    using Entry = std::pair<double, uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    cost[from] = 0;
    open.emplace(0, from);
    while (!open.empty()) {
        const auto [so_far, lane] = open.top();
        open.pop();
        if (so_far > cost[lane]) continue;
        if (lane == to) break;
        for (const uint32_t next : lanes_[lane].successors)
            if (const double through = so_far + lanes_[lane].length; through < cost[next]) {
                cost[next] = through, before[next] = lane;
                open.emplace(through, next);
            }
    }
    if (!std::isfinite(cost[to])) return {};
    std::vector<uint32_t> way{to};
    while (way.back() != from) way.push_back(before[way.back()]);
    std::reverse(way.begin(), way.end());
    return way;
}

std::vector<uint32_t> LaneGraph::long_route(uint32_t from) const {
    std::vector<uint32_t> way{from};
    std::vector<bool> entered(lanes_.size());
    entered[from] = true;
    // How far one gets from a lane over the next few, so that the way does not end in the first short stub.
    size_t looks = 0;
    const auto outlook = [&](const auto& self, uint32_t lane, int depth) -> double {
        double best = 0;
        if (++looks < kMaxWaySteps && depth > 0)
            for (const uint32_t next : lanes_[lane].successors)
                if (!entered[next]) best = std::max(best, self(self, next, depth - 1));
        return lanes_[lane].length + best;
    };
    while (true) {
        uint32_t best = kNoLane;
        double most = 0;
        for (const uint32_t next : lanes_[way.back()].successors)
            if (!entered[next] && is_driven(lanes_[next].type))
                if (const double ahead = outlook(outlook, next, 6); ahead > most) best = next, most = ahead;
        if (best == kNoLane) return way;
        entered[best] = true;
        way.push_back(best);
    }
}

uint32_t LaneGraph::straight_on(uint32_t lane) const {
    uint32_t best = kNoLane;
    for (const uint32_t next : lanes_[lane].successors)
        if (best == kNoLane || turn_between(lanes_[lane], lanes_[next]) < turn_between(lanes_[lane], lanes_[best]))
            best = next;
    return best;
}

LanePlace LaneGraph::advance(LanePlace place, double distance) const {
    place.along += distance;
    while (place.along > lanes_[place.lane].length) {
        const uint32_t next = straight_on(place.lane);
        if (next == kNoLane) break;
        place.along -= lanes_[place.lane].length;
        place.lane = next;
    }
    while (place.along < 0) {
        uint32_t before = kNoLane;
        for (const uint32_t each : lanes_[place.lane].predecessors)
            if (before == kNoLane ||
                turn_between(lanes_[each], lanes_[place.lane]) < turn_between(lanes_[before], lanes_[place.lane]))
                before = each;
        if (before == kNoLane) break;
        place.lane = before;
        place.along += lanes_[before].length;
    }
    place.along = std::clamp(place.along, 0.0, lanes_[place.lane].length);
    return place;
}

std::vector<uint32_t> LaneGraph::kerbs_near(glm::dvec3 point, double reach) const {
    std::vector<uint32_t> found = kerb_grid_.near(from_above(point), reach);
    std::erase_if(found, [&](uint32_t index) {
        const Kerb& kerb = kerbs_[index];
        const glm::dvec3 a{kerb.from.x, 0, kerb.from.z}, b{kerb.to.x, 0, kerb.to.z}, p{point.x, 0, point.z};
        return glm::distance(p, a + (b - a) * fraction_near(a, b, p)) > reach;
    });
    return found;
}

}  // namespace vesper::roads
