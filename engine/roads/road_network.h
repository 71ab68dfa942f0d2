// Roads as OpenDRIVE describes them, typed and checked. SPDX-License-Identifier: MIT
// The file's own frame: x east, y north, z up, m; headings rad, counter-clockwise from x. s runs along a road's
// reference line (seen from above), t to its left. Speeds m/s.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "roads/plan_curve.h"

namespace vesper::roads {

constexpr uint32_t kNoRoad = ~0u;  ///< "no such element" wherever an index is kept

/// a + b d + c d^2 + d d^3 with d = s - s0.
struct Cubic {
    double s = 0, a = 0, b = 0, c = 0, d = 0;
    double at(double at_s) const { return a + (at_s - s) * (b + (at_s - s) * (c + (at_s - s) * d)); }
    double slope(double at_s) const { return b + (at_s - s) * (2 * c + (at_s - s) * 3 * d); }
};

/// Cubics one after another, s ascending: each counts from its s to the next one's. 0 without any and before the first.
struct Profile {
    std::vector<Cubic> parts;
    const Cubic* part_at(double s) const;
    double at(double s) const;
    double slope(double s) const;
};

enum class LaneType : uint8_t {
    None,
    Driving,
    Stop,
    Shoulder,
    Biking,
    Sidewalk,
    Border,
    Restricted,
    Parking,
    Median,
    Curb,
    Entry,
    Exit,
    Ramp,
    Bidirectional,
    Rail,
    Other
};
const char* name_of(LaneType);
/// Whether cars drive there: driving, entry, exit, ramps, bidirectional.
bool is_driven(LaneType);
/// Whether a car finds no kerb in its way: the driven ones, stop, shoulder, border, parking, biking, restricted.
bool is_level_with_road(LaneType);

enum class MarkColour : uint8_t { White, Yellow, Red, Blue, Green, Orange, Black };

/// One line of a road mark, or one strip of its pattern.
struct MarkLine {
    double width = 0.12;  ///< m
    double t_offset = 0;  ///< m, from the lane's border, positive to the left
    double length = 0;    ///< m painted; 0: without end
    double space = 0;     ///< m not painted after it
    double s_offset = 0;  ///< m, of the first from the beginning of the mark
    double once = 0;      ///< m painted once, from s_offset on (an explicit line); 0: repeated
    MarkColour colour = MarkColour::White;
};

/// Paint along a lane's outer border (the centre lane's: along the lane reference) from s to the next mark.
struct RoadMark {
    double s = 0;
    std::string type;  ///< as stated: "solid", "broken", ...
    bool curb = false, botts_dots = false;
    std::vector<MarkLine> lines;
};

struct LaneHeight {
    double s = 0, inner = 0, outer = 0;  ///< m above the road's surface, at either border, from s on
};

struct SpeedLimit {
    double s = 0;
    double limit = 0;  ///< m/s; 0: none stated, infinite: stated that there is none
};

enum class LaneDirection : uint8_t { Standard, Reversed, Both };

struct RoadLane {
    int id = 0;  ///< > 0 left, < 0 right of the reference, 0 the centre, which has no width
    LaneType type = LaneType::None;
    LaneDirection direction = LaneDirection::Standard;
    bool level = false;  ///< does not follow the superelevation
    Profile width;       ///< m; s along the road
    Profile border;      ///< or t of the outer border relative to the centre lane
    std::vector<LaneHeight> heights;
    std::vector<RoadMark> marks;
    std::vector<SpeedLimit> speeds;
    std::vector<int> predecessors, successors;  ///< lane ids
    bool missing = false;                       ///< its id is missing in the file: it has no width
};

struct LaneSection {
    double s = 0, end = 0;
    std::vector<RoadLane> lanes;  ///< ids descending: from the left to the right; the centre is always there
    const RoadLane* find(int id) const;
    int leftmost() const { return lanes.front().id; }
    int rightmost() const { return lanes.back().id; }
};

/// Which end of a road.
enum class RoadEnd : uint8_t { Start, End };

struct RoadLink {
    enum class To : uint8_t { Nothing, Road, Junction };
    To to = To::Nothing;
    uint32_t index = kNoRoad;  ///< into roads or junctions
    RoadEnd contact = RoadEnd::Start;
};

/// Lateral shape: heights over t at one s, linear in s between them.
struct RoadShape {
    double s = 0;
    std::vector<Cubic> parts;  ///< of t
};

/// A strip of a cross section (1.8): c + l t + q t^2 + k t^3 with t from its inner edge, to the left positive; all over
/// s.
struct SurfaceStrip {
    int id = 0;             ///< 1, 2, ... to the left from the middle of the cross section, -1, -2, ... to the right
    bool relative = false;  ///< begins as high as the strip inside it ends
    Profile width;          ///< m; none: as far as there is road
    Profile constant, linear, quadratic, cubic;
};

struct ObjectCorner {
    int id = 0;
    bool local = true;           ///< u, v, z in the object's frame; otherwise s, t, height above the road
    double u = 0, v = 0, z = 0;  ///< m; or s, t, dz
    double height = 0;           ///< m
};

struct ObjectOutline {
    bool closed = true;
    std::vector<ObjectCorner> corners;
};

struct ObjectMarking {
    double width = 0.1, z_offset = 0.005;
    double line_length = 0, space_length = 0, start_offset = 0, stop_offset = 0;
    MarkColour colour = MarkColour::White;
    std::vector<int> corners;  ///< ids, in order
    std::string side;          ///< of the bounding box: "front", "rear", "left", "right"
};

struct ObjectRepeat {
    double s = 0, length = 0;
    double distance = 0;  ///< m between copies; 0: one continuous body
    double t_start = 0, t_end = 0, z_start = 0, z_end = 0;
    std::optional<double> height_start, height_end, width_start, width_end, length_start, length_end, radius_start,
        radius_end;
};

struct RoadObject {
    std::string id, name, type, subtype;
    double s = 0, t = 0, z_offset = 0;
    double heading = 0, pitch = 0, roll = 0;               ///< relative to the road
    char orientation = '0';                                ///< '+', '-' or '0' for none
    double length = 0, width = 0, height = 0, radius = 0;  ///< m; 0: not stated
    std::vector<ObjectRepeat> repeats;
    std::vector<ObjectOutline> outlines;
    std::vector<ObjectMarking> markings;
};

struct RoadSignal {
    std::string id, name, type, subtype, country, text;
    double value = 0;
    std::string unit;
    bool dynamic = false;
    double s = 0, t = 0, z_offset = 0;
    double heading = 0, pitch = 0, roll = 0;
    char orientation = '0';  ///< '+': for traffic in direction +s, which it faces; '-': against it
    double width = 0, height = 0;
    uint32_t counts_on = kNoRoad;  ///< the road whose traffic it is for, if it stands beside another
    double counts_at = 0;          ///< m along that road
};

struct Road {
    std::string id, name;
    size_t line = 0;  ///< of the file
    double length = 0;
    bool right_hand = true;  ///< traffic keeps to the right
    uint32_t junction = kNoRoad;
    RoadLink predecessor, successor;
    std::vector<PlanGeometry> plan;  ///< s ascending
    Profile elevation, superelevation, lane_offset;
    Profile crossfall_left, crossfall_right;  ///< rad, falling outwards where positive (before 1.6)
    std::vector<RoadShape> shapes;
    Profile strips_offset;             ///< t of the middle of the cross section
    std::vector<SurfaceStrip> strips;  ///< from the middle outwards on either side
    std::vector<LaneSection> sections;
    std::vector<SpeedLimit> speeds;
    std::string type;  ///< of its first stretch: "town", "motorway", ...
    std::vector<RoadObject> objects;
    std::vector<RoadSignal> signals;
    std::vector<std::string> signal_references;  ///< ids of signals of any road that count here

    size_t section_at(double s) const;  ///< index; there must be one
};

struct JunctionConnection {
    uint32_t incoming = kNoRoad, connecting = kNoRoad;
    RoadEnd contact = RoadEnd::Start;        ///< of the connecting road
    std::vector<std::pair<int, int>> lanes;  ///< from, to
};

struct Junction {
    std::string id, name;
    bool direct = false;  ///< roads meet without connecting roads
    std::vector<JunctionConnection> connections;
    std::vector<std::string> controllers;  ///< ids
};

/// Signals that show the same at any time.
struct SignalController {
    std::string id;
    std::vector<std::string> signals;  ///< ids
};

struct RoadNetwork {
    std::string name;
    int major = 1, minor = 0;  ///< revision of OpenDRIVE
    glm::dvec3 origin{0};      ///< of the world, in the file's frame: near the roads, for the precision of floats
    std::vector<Road> roads;
    std::vector<Junction> junctions;
    std::map<std::string, size_t> unread;  ///< elements ("lane/access") and attributes ("lane@level") that are not read
    std::vector<SignalController> controllers;
    std::vector<std::string> notes;  ///< corrections and omissions, one line each

    /// From the file's frame to the world: X = x, Y = z, Z = -y, from the origin.
    glm::dvec3 to_world(glm::dvec3 point) const { return direction_to_world(point - origin); }
    static glm::dvec3 direction_to_world(glm::dvec3 d) { return {d.x, d.z, -d.y}; }
};

}  // namespace vesper::roads
