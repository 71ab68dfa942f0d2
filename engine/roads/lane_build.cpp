// Lanes of a road network: poses, neighbours, links. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "base/budget.h"
#include "base/error.h"
#include "roads/lane_build.h"
#include "roads/road_surface.h"

namespace vesper::roads {
namespace {

constexpr double kChord = 0.005;              // m
constexpr double kLongestPose = 5;            // m
constexpr double kNarrowest = 0.1;            // m; a lane that never is wider is none
constexpr double kLinkGap = 3;                // m; links further than this lead nowhere
constexpr double kMeet = 0.3;                 // m, and within 20 degrees
constexpr double kSameStation = 0.05;         // m
constexpr size_t kMostFollowers = 64;         // of one lane; crossings have five
constexpr size_t kMaxLinkTests = 50'000'000;  // at lanes that may follow though nothing says so
constexpr size_t kMaxPoses = 20'000'000;

bool is_wanted(LaneType type) {
    return is_driven(type) || type == LaneType::Biking || type == LaneType::Sidewalk || type == LaneType::Parking;
}

/// Where a lane is in the file; forwards or not.
using Key = std::tuple<uint32_t, uint32_t, int, bool>;

struct Builder {
    const RoadNetwork& network;
    std::vector<Lane> lanes{};
    size_t poses = 0;
    std::map<Key, uint32_t> by_key{};

    uint32_t find(uint32_t road, size_t section, int id, bool forwards) const {
        const auto found = by_key.find({road, static_cast<uint32_t>(section), id, forwards});
        return found == by_key.end() ? kNoLane : found->second;
    }
    void link(uint32_t from, uint32_t to) {
        if (from == kNoLane || to == kNoLane) return;
        if (glm::distance(lanes[from].poses.back().position, lanes[to].poses.front().position) > kLinkGap) return;
        auto& after = lanes[from].successors;
        if (after.size() >= kMostFollowers || std::find(after.begin(), after.end(), to) != after.end()) return;
        after.push_back(to);
        lanes[to].predecessors.push_back(from);
    }
};

double limit_at(const std::vector<SpeedLimit>& limits, double s) {
    const auto after = std::upper_bound(limits.begin(), limits.end(), s + 1e-6,
                                        [](double at, const SpeedLimit& each) { return at < each.s; });
    return after == limits.begin() ? 0 : (after - 1)->limit;
}

/// The stations and where the limits change, but for what is nearer than kSameStation to another.
std::vector<double> with_limits(const std::vector<double>& stations, const std::vector<SpeedLimit>& of_lane,
                                const std::vector<SpeedLimit>& of_road) {
    std::vector<double> changes, all = stations;
    for (const auto* limits : {&of_lane, &of_road})
        for (auto each = std::upper_bound(limits->begin(), limits->end(), stations.front(),
                                          [](double at, const SpeedLimit&limit) { return at < limit.s; });
             each != limits->end() && each->s < stations.back(); ++each)
            changes.push_back(each->s);
    std::sort(changes.begin(), changes.end());
    double last = stations.front();
    for (const double s : changes) {
        const auto next = std::lower_bound(stations.begin(), stations.end(), s);
        if (*next - s < kSameStation || s - std::max(*(next - 1), last) < kSameStation) continue;
        all.push_back(last = s);
    }
    std::sort(all.begin(), all.end());
    return all;
}

/// Distances, directions and bends of a polyline of positions.
void finish(Lane& lane) {
    lane.along.assign(1, 0);
    for (size_t i = 1; i < lane.poses.size(); ++i)
        lane.along.push_back(lane.along.back() + glm::distance(lane.poses[i - 1].position, lane.poses[i].position));
    lane.length = lane.along.back();
    for (size_t i = 0; i < lane.poses.size(); ++i) {
        // The road's direction is not the lane's where it widens; a parabola through three points is.
        const size_t a = i == 0 ? 0 : i - 1, b = std::min(i + 1, lane.poses.size() - 1);
        glm::dvec3 forward = lane.poses[b].position - lane.poses[a].position;
        if (i > 0 && i + 1 < lane.poses.size()) {
            const double before = lane.along[i] - lane.along[a], after = lane.along[b] - lane.along[i];
            forward = (lane.poses[i].position - lane.poses[a].position) * (after / before) +
                      (lane.poses[b].position - lane.poses[i].position) * (before / after);
        } else if (lane.poses.size() > 2) {
            // At the ends: twice the chord less the direction at the other end of it, which is exact for arcs.
            const size_t other = i == 0 ? 1 : i - 1, beyond = i == 0 ? 2 : i - 2;
            const glm::dvec3 chord = lane.poses[b].position - lane.poses[a].position;
            const glm::dvec3 next = i == 0 ? lane.poses[beyond].position - lane.poses[other].position
                                           : lane.poses[other].position - lane.poses[beyond].position;
            const double first = glm::length(chord), second = glm::length(next);
            const glm::dvec3 u = chord / first, v = next / second;
            forward = u + (u - v) * (first / (first + second));
        }
        lane.poses[i].forward = glm::normalize(forward);
        lane.poses[i].up = glm::normalize(lane.poses[i].up -
                                          lane.poses[i].forward * glm::dot(lane.poses[i].up, lane.poses[i].forward));
    }
    for (size_t i = 0; i < lane.poses.size(); ++i) {
        const size_t a = i == 0 ? 0 : i - 1, b = std::min(i + 1, lane.poses.size() - 1);
        const glm::dvec3 u = lane.poses[a].forward, v = lane.poses[b].forward;
        const double turn = std::atan2(u.z * v.x - u.x * v.z, u.x * v.x + u.z * v.z);  // about +Y
        lane.poses[i].curvature = turn / (lane.along[b] - lane.along[a]);
    }
}

void add_lane(Builder& builder, uint32_t road_index, uint32_t section_index, const RoadLane& from, bool forwards,
              const std::vector<double>& of_section) {
    const Road& road = builder.network.roads[road_index];
    const LaneSection& section = road.sections[section_index];
    const std::vector<double> stations = with_limits(of_section, from.speeds, road.speeds);
    Lane lane;
    lane.road = road_index, lane.section = section_index, lane.id = from.id, lane.type = from.type;
    lane.in_junction = road.junction != kNoRoad;
    lane.forwards = forwards;
    lane.name = "road " + road.id + ", section " + std::to_string(section_index) + ", lane " + std::to_string(from.id);
    builder.poses += stations.size();
    if (builder.poses > kMaxPoses) throw Error("the lanes have more points than " + std::to_string(kMaxPoses));
    spend(stations.size() * sizeof(LanePose));
    double widest = 0;
    for (size_t i = 0; i < stations.size(); ++i) {
        const double s = stations[i];
        const RoadPoint point = lane_point(road, section, from.id, s, 0.5);
        LanePose pose;
        pose.position = builder.network.to_world(point.position);
        pose.up = RoadNetwork::direction_to_world(point.up);
        pose.width = std::abs(lane_border(road, section, from.id, s) -
                              lane_border(road, section, from.id > 0 ? from.id - 1 : from.id + 1, s));
        widest = std::max(widest, pose.width);
        // From here on in the direction of travel.
        const double other = forwards ? stations[std::min(i + 1, stations.size() - 1)] : stations[i == 0 ? 0 : i - 1];
        const double within = other == s ? (stations[i] + stations[i == 0 ? 1 : i - 1]) / 2 : (s + other) / 2;
        pose.speed_limit = limit_at(from.speeds, within);
        if (pose.speed_limit <= 0) pose.speed_limit = limit_at(road.speeds, within);
        if (lane.poses.empty() || glm::distance(pose.position, lane.poses.back().position) > 1e-4)
            lane.poses.push_back(pose);
    }
    if (lane.poses.size() < 2 || widest < kNarrowest) return;
    if (!forwards) std::reverse(lane.poses.begin(), lane.poses.end());
    finish(lane);
    lane.speed_limit = lane.poses.front().speed_limit;
    builder.by_key[{road_index, section_index, from.id, forwards}] = static_cast<uint32_t>(builder.lanes.size());
    builder.lanes.push_back(std::move(lane));
}

void add_section(Builder& builder, uint32_t road_index, uint32_t section_index) {
    const Road& road = builder.network.roads[road_index];
    const LaneSection& section = road.sections[section_index];
    if (std::none_of(section.lanes.begin(), section.lanes.end(),
                     [](const RoadLane& lane) { return is_wanted(lane.type); }))
        return;
    const std::vector<double> stations = road_stations(road, section, kChord, kLongestPose);
    for (const RoadLane& lane : section.lanes) {
        if (lane.id == 0 || !is_wanted(lane.type)) continue;
        const bool forwards = (lane.id < 0) == road.right_hand;
        const bool reversed = lane.direction == LaneDirection::Reversed;
        add_lane(builder, road_index, section_index, lane, forwards != reversed, stations);
        if (lane.direction == LaneDirection::Both)
            add_lane(builder, road_index, section_index, lane, !forwards, stations);
    }
}

void find_neighbours(Builder& builder) {
    for (Lane& lane : builder.lanes) {
        const int outwards = lane.id > 0 ? 1 : -1;
        const LaneSection& section = builder.network.roads[lane.road].sections[lane.section];
        const auto beside = [&](int step) {
            int id = lane.id + step;
            for (const RoadLane* each = section.find(id); each && each->missing; each = section.find(id)) id += step;
            const uint32_t found = id == 0 ? kNoLane : builder.find(lane.road, lane.section, id, lane.forwards);
            return found != kNoLane && builder.lanes[found].type == lane.type ? found : kNoLane;
        };
        // +t, where ids grow, is to the left of who travels forwards.
        const int to_left = lane.forwards ? 1 : -1;
        lane.left = beside(to_left), lane.right = beside(-to_left);
        for (int step = 1; step < 32 && lane.oncoming == kNoLane; ++step) {
            const int id = lane.id - outwards * step;
            const uint32_t found = id == 0 ? kNoLane : builder.find(lane.road, lane.section, id, !lane.forwards);
            if (found != kNoLane && is_driven(builder.lanes[found].type)) lane.oncoming = found;
        }
    }
}

/// A lane's target on a road that is entered at one of its ends.
uint32_t entered(const Builder& builder, uint32_t road_index, RoadEnd end, int id) {
    const Road& road = builder.network.roads[road_index];
    if (road.sections.empty()) return kNoLane;
    return builder.find(road_index, end == RoadEnd::Start ? 0 : road.sections.size() - 1, id, end == RoadEnd::Start);
}

/// The lane that ends where a road is left at `end`.
uint32_t leaving(const Builder& builder, uint32_t road_index, RoadEnd end, int id) {
    const Road& road = builder.network.roads[road_index];
    if (road.sections.empty()) return kNoLane;
    return builder.find(road_index, end == RoadEnd::Start ? 0 : road.sections.size() - 1, id, end == RoadEnd::End);
}

/// What the file states of one lane of a section, at either of its ends, for either direction.
void link_lane(Builder& builder, uint32_t road_index, uint32_t section_index, const RoadLane& lane) {
    const Road& road = builder.network.roads[road_index];
    const auto at_end = [&](RoadEnd end) {
        const bool last = end == RoadEnd::End;
        const bool inside = last ? section_index + 1 < road.sections.size() : section_index > 0;
        const uint32_t out = builder.find(road_index, section_index, lane.id, last),
                       in = builder.find(road_index, section_index, lane.id, !last);
        for (const int id : last ? lane.successors : lane.predecessors) {
            if (inside) {
                const uint32_t next = last ? section_index + 1 : section_index - 1;
                builder.link(out, builder.find(road_index, next, id, last));
                builder.link(builder.find(road_index, next, id, !last), in);
                continue;
            }
            const RoadLink& link = last ? road.successor : road.predecessor;
            if (link.to != RoadLink::To::Road) continue;
            builder.link(out, entered(builder, link.index, link.contact, id));
            builder.link(leaving(builder, link.index, link.contact, id), in);
        }
    };
    at_end(RoadEnd::Start);
    at_end(RoadEnd::End);
}

void link_junction(Builder& builder, const Junction& junction, uint32_t index) {
    for (const JunctionConnection& each : junction.connections) {
        const Road& incoming = builder.network.roads[each.incoming];
        for (const RoadEnd end : {RoadEnd::Start, RoadEnd::End}) {
            const RoadLink& link = end == RoadEnd::Start ? incoming.predecessor : incoming.successor;
            if (link.to != RoadLink::To::Junction || link.index != index) continue;
            for (const auto& [from, to] : each.lanes) {
                builder.link(leaving(builder, each.incoming, end, from),
                             entered(builder, each.connecting, each.contact, to));
                builder.link(leaving(builder, each.connecting, each.contact, to),
                             entered(builder, each.incoming, end, from));
            }
        }
    }
}

}  // namespace

std::vector<Lane> build_lanes(const RoadNetwork& network) {
    Builder builder{network};
    for (uint32_t r = 0; r < network.roads.size(); ++r)
        for (uint32_t s = 0; s < network.roads[r].sections.size(); ++s) add_section(builder, r, s);
    find_neighbours(builder);
    for (uint32_t r = 0; r < network.roads.size(); ++r)
        for (uint32_t s = 0; s < network.roads[r].sections.size(); ++s)
            for (const RoadLane& lane : network.roads[r].sections[s].lanes) link_lane(builder, r, s, lane);
    for (uint32_t j = 0; j < network.junctions.size(); ++j) link_junction(builder, network.junctions[j], j);
    return std::move(builder.lanes);
}

void link_where_they_meet(std::vector<Lane>& lanes) {
    SegmentGrid starts(0.5);
    size_t looks = 0;
    std::vector<uint32_t> last_section;  // of each road, that has lanes
    for (const Lane& lane : lanes) {
        last_section.resize(std::max<size_t>(last_section.size(), lane.road + 1));
        last_section[lane.road] = std::max(last_section[lane.road], lane.section);
    }
    // Of one road the next section follows, or where it is a ring the one at its other end.
    const auto adjoin = [&](const Lane& a, const Lane& b) {
        const uint32_t next = a.forwards ? a.section + 1 : a.section - 1, end = last_section[a.road];
        return a.forwards == b.forwards &&
               (b.section == next || (a.section == (a.forwards ? end : 0) && b.section == (a.forwards ? 0 : end)));
    };
    for (const Lane& lane : lanes) {
        const glm::dvec3 at = lane.poses.front().position;
        starts.add({at.x, at.z}, {at.x, at.z});
    }
    for (uint32_t from = 0; from < lanes.size(); ++from) {
        if (!lanes[from].successors.empty()) continue;
        const LanePose& end = lanes[from].poses.back();
        const std::vector<uint32_t> near = starts.near({end.position.x, end.position.z}, kMeet);
        if ((looks += near.size()) > kMaxLinkTests) return;
        for (const uint32_t to : near) {
            if (lanes[from].successors.size() >= kMostFollowers) break;
            if (lanes[to].road == lanes[from].road && !adjoin(lanes[from], lanes[to])) continue;
            const LanePose& start = lanes[to].poses.front();
            if (lanes[to].type != lanes[from].type && !(is_driven(lanes[to].type) && is_driven(lanes[from].type)))
                continue;
            if (lanes[to].road == lanes[from].road && lanes[to].id == -lanes[from].id) continue;
            if (glm::distance(start.position, end.position) > kMeet || glm::dot(start.forward, end.forward) < 0.94)
                continue;
            lanes[from].successors.push_back(to);
            lanes[to].predecessors.push_back(from);
        }
    }
}

std::vector<Kerb> build_kerbs(const RoadNetwork& network) {
    std::vector<Kerb> kerbs;
    for (const Road& road : network.roads)
        for (const LaneSection& section : road.sections) {
            std::vector<double> stations;
            for (const int side : {1, -1}) {
                // From the reference outwards: the first border behind which no car may be, if there is anything to
                // drive on.
                bool driven = false;
                for (int id = side;; id += side) {
                    const RoadLane *lane = section.find(id), *outer = section.find(id + side);
                    if (!lane) break;
                    driven = driven || is_driven(lane->type);
                    const bool curb = std::any_of(lane->marks.begin(), lane->marks.end(),
                                                  [](const RoadMark& mark) { return mark.curb; });
                    if (!is_level_with_road(lane->type) || !driven) continue;
                    if (outer && is_level_with_road(outer->type) && !curb) continue;
                    if (stations.empty()) stations = road_stations(road, section, 0.02, 8);
                    for (size_t i = 1; i < stations.size(); ++i) {
                        const RoadPoint a = lane_point(road, section, id, stations[i - 1], 1),
                                        b = lane_point(road, section, id, stations[i], 1);
                        Kerb kerb{network.to_world(a.position), network.to_world(b.position)};
                        const glm::dvec3 inside = RoadNetwork::direction_to_world(a.left) * (side > 0 ? -1.0 : 1.0);
                        kerb.inside = glm::normalize(glm::dvec3(inside.x, 0, inside.z));
                        if (outer)
                            kerb.height = std::max(
                                0.0, lane_height(*outer, stations[i - 1], 0) - lane_height(*lane, stations[i - 1], 1));
                        if (outer && kerb.height <= 0 &&
                            (curb || outer->type == LaneType::Sidewalk || outer->type == LaneType::Curb))
                            kerb.height = 0.12;
                        kerbs.push_back(kerb);
                    }
                    break;
                }
            }
        }
    return kerbs;
}

}  // namespace vesper::roads
