// Points on roads: reference line, surface, lane borders. SPDX-License-Identifier: MIT
#pragma once

#include "roads/road_network.h"

namespace vesper::roads {

/// A point of a road in the file's frame.
struct RoadPoint {
    glm::dvec3 position{0};
    glm::dvec3 forward{1, 0, 0};  ///< unit, along +s, climbing with the road
    glm::dvec3 left{0, 1, 0};     ///< unit, along +t, in the tilted surface
    glm::dvec3 up{0, 0, 1};       ///< unit, forward x left
    double heading = 0;           ///< rad
    double curvature = 0;         ///< of the reference line in plan, 1/m
};

/// The reference line at s (beyond the road's ends: straight on). s is measured in plan.
RoadPoint reference_point(const Road& road, double s);

/// The road's surface at (s, t): elevation, superelevation (a turn of the cross section about the reference line),
/// crossfall and shape. `height` m are added along the surface's normal.
RoadPoint surface_point(const Road& road, double s, double t, double height = 0);

/// The stated width of a lane, m; may be negative.
double stated_width(const LaneSection& section, const RoadLane& lane, double s);

/// t of a lane's outer border (id 0: of the centre lane, which is the lane offset). Lanes that are narrower than 0 have
/// no width. The lane must be there.
double lane_border(const Road& road, const LaneSection& section, int id, double s);

/// Height of a lane above the surface at a fraction of its width, 0 inner to 1 outer.
double lane_height(const RoadLane& lane, double s, double fraction);

/// A point of a lane: `fraction` of its width from the inner border, its own height and level lanes included.
RoadPoint lane_point(const Road& road, const LaneSection& section, int id, double s, double fraction);

/// Every s in [from, to] where something changes (geometries, profiles, widths, marks), and between them enough that
/// neither the reference line nor the border of any lane leaves its chord by more than `chord` m, none longer than
/// `longest` m.
std::vector<double> road_stations(const Road& road, const LaneSection& section, double chord, double longest);

}  // namespace vesper::roads
