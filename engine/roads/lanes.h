// The lanes of a road network as a graph, for traffic, autopilot and collisions with kerbs.
// SPDX-License-Identifier: MIT
// Everything is in the world of the scene (Y up, m) and in the direction of travel: `along` is the distance from where
// a lane is entered, `offset` the distance from its centre, positive to the left. Speeds m/s.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "roads/road_network.h"
#include "roads/segment_grid.h"

namespace vesper::roads {

constexpr uint32_t kNoLane = ~0u;

/// Pose of the centre of a lane.
struct LanePose {
    glm::dvec3 position{0};
    glm::dvec3 forward{0, 0, -1};  ///< unit, the direction of travel, climbing with the road
    glm::dvec3 up{0, 1, 0};        ///< unit, the normal of the surface
    double width = 0;              ///< m
    double curvature = 0;          ///< 1/m, seen from above, positive: the lane bends to the left
    double speed_limit = 0;        ///< m/s from here to the next pose; 0: none stated, infinite: stated that there is
                                   ///< none
    glm::dvec3 left() const { return glm::cross(up, forward); }
};

/// One lane of one lane section of a road, in one direction. Positions are within 5 mm of the file.
struct Lane {
    std::string name;      ///< "road 3, section 0, lane -1" with the ids of the file
    uint32_t road = 0;     ///< index into RoadNetwork::roads
    uint32_t section = 0;  ///< of the road
    int id = 0;            ///< of the file
    LaneType type = LaneType::Driving;
    bool in_junction = false;                        ///< its road is part of a junction
    bool forwards = true;                            ///< travels in the direction of the road's s
    double length = 0;                               ///< m, > 0
    double speed_limit = 0;                          ///< m/s of its first pose
    std::vector<uint32_t> successors, predecessors;  ///< lanes after its end, lanes before its start
    uint32_t left = kNoLane, right = kNoLane;        ///< next to it, of the same type and direction
    uint32_t oncoming = kNoLane;  ///< the nearest driven lane of the other direction of the same section
    std::vector<double> along;    ///< of the poses, ascending from 0 to length
    std::vector<LanePose> poses;
};

/// The speed limit from a pose of a lane on, m/s, at most 130 km/h. Without a statement: 50 km/h, in junctions
/// `before`.
double allowed_speed(const Lane& lane, const LanePose& pose, double before = 0);

/// A place on a lane.
struct LanePlace {
    uint32_t lane = kNoLane;
    double along = 0;     ///< m
    double offset = 0;    ///< m to the left of the centre
    double distance = 0;  ///< m, from the requested point to the centre line
};

/// A stretch of kerb: the edge of the area for cars, at the level of the road.
struct Kerb {
    glm::dvec3 from{0}, to{0};
    glm::dvec3 inside{0};  ///< unit, horizontal, towards the road
    double height = 0;     ///< m above the road behind the kerb; 0: the road ends without a step
};

/// The lanes of a network. Copies are deep. Const functions may be called from several threads at once.
class LaneGraph {
public:
    LaneGraph() = default;
    /// Lanes of the driven types, biking, sidewalk and parking. Missing links are added if a lane begins within 0.3 m
    /// of the end of another, in its direction.
    explicit LaneGraph(const RoadNetwork& network);

    std::span<const Lane> lanes() const { return lanes_; }
    std::span<const Kerb> kerbs() const { return kerbs_; }

    /// The pose at a distance along a lane; beyond its ends straight on. Continuous in `along`.
    LanePose pose(uint32_t lane, double along) const;
    /// pose() moved by the offset, with the forward direction of the lane.
    LanePose pose(const LanePlace& place) const { return pose_beside(place.lane, place.along, place.offset); }
    LanePose pose_beside(uint32_t lane, double along, double offset) const;

    /// The nearest lane within `reach` m of a point that `wanted` accepts (default: driven lanes). The distance is in
    /// three dimensions, so bridges differ from roads below.
    std::optional<LanePlace> nearest(glm::dvec3 point, double reach = 20,
                                     const std::function<bool(const Lane&)>& wanted = {}) const;
    /// As nearest(), with a preference for the direction `forward`: a lane across or against it counts as up to 4 m
    /// further away.
    std::optional<LanePlace> nearest_along(glm::dvec3 point, glm::dvec3 forward, double reach = 20) const;

    /// The shortest route from a lane to another over successors, both included; empty if there is none.
    std::vector<uint32_t> route(uint32_t from, uint32_t to) const;
    /// The longest way (greedily, m) over driven lanes that begins at `from` and enters no lane twice.
    std::vector<uint32_t> long_route(uint32_t from) const;
    /// The place `distance` m further (negative: back), over the straightest successors or over predecessors. Stops at
    /// dead ends. Keeps the offset.
    LanePlace advance(LanePlace place, double distance) const;
    /// The successor that turns least; kNoLane at a dead end.
    uint32_t straight_on(uint32_t lane) const;

    /// Indices of the kerbs within `reach` m of a point, seen from above; ascending.
    std::vector<uint32_t> kerbs_near(glm::dvec3 point, double reach) const;

private:
    using Cost = std::function<double(const Lane&, const LanePose&)>;
    /// The place of the least distance plus cost, >= 0.
    std::optional<LanePlace> cheapest(glm::dvec3 point, double reach, const Cost& cost) const;

    std::vector<Lane> lanes_;
    std::vector<Kerb> kerbs_;
    SegmentGrid lane_grid_, kerb_grid_;
    std::vector<std::pair<uint32_t, uint32_t>> lane_segments_;  ///< lane and pose of each entry of lane_grid_
};

}  // namespace vesper::roads
