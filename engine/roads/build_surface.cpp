// Lane surfaces, kerbs and the sides of roads. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/budget.h"
#include "base/error.h"
#include "roads/lit_road_parts.h"

namespace vesper::roads {
namespace {

constexpr double kLongestStation = 20;  // m between stations
constexpr double kPiece = 60;           // m of road in one mesh, short enough to be culled
constexpr size_t kMaxEdges = 4'000'000;
constexpr double kStep = 0.02;          // m; higher edges get a face
constexpr double kKerbWidth = 0.15;     // m of kerb stone
constexpr double kLift = 0.003;         // m that driven lanes of junctions lie over what else is there
constexpr double kGrassDrop = 0.03;     // m
constexpr double kInsideSurface = 0.1;  // m
constexpr double kBridge = 2.5;         // m over the ground from which a road is a bridge
constexpr double kDeck = 1;             // m
constexpr double kBeyondLane = 0.2;     // m beyond the end of a lane, and of a chord from its arc

/// Borders are hard, but the outermost one, where it is wide, is what files have for the verge.
RoadMaterial stuff_of(LaneType type, bool verge) {
    if (verge) return RoadMaterial::Grass;
    switch (type) {
        case LaneType::Driving:
        case LaneType::Entry:
        case LaneType::Exit:
        case LaneType::Ramp:
        case LaneType::Bidirectional:
        case LaneType::Parking:
        case LaneType::Restricted:
            return RoadMaterial::Asphalt;
        case LaneType::Stop:
        case LaneType::Shoulder:
        case LaneType::Border:
            return RoadMaterial::Shoulder;
        case LaneType::Biking:
            return RoadMaterial::Bikeway;
        case LaneType::Sidewalk:
            return RoadMaterial::Pavement;
        case LaneType::Curb:
            return RoadMaterial::Kerb;
        case LaneType::Rail:
            return RoadMaterial::Gravel;
        default:
            return RoadMaterial::Grass;
    }
}

RoadMesh::Corner corner(const RoadPoint& point, double lift = 0) {
    return {point.position + point.up * lift, point.up};
}

RoadPoint between(const RoadPoint& a, const RoadPoint& b, double f) {
    RoadPoint point = a;
    point.position = glm::mix(a.position, b.position, f);
    point.up = glm::normalize(glm::mix(a.up, b.up, f));
    return point;
}

/// A strip between two lines; `left` is where it has its left edge.
void strip(RoadMesh& mesh, RoadMaterial stuff, const RoadPoint& right0, const RoadPoint& right1, const RoadPoint& left0,
           const RoadPoint& left1, double lift) {
    mesh.quad(stuff, corner(right0, lift), corner(right1, lift), corner(left1, lift), corner(left0, lift));
}

struct SectionBuilder {
    RoadBuild& build;
    const CutSection& cut;
    const Road& road = build.network.roads[cut.road];
    const LaneSection& section = road.sections[cut.section];
    RoadMesh& mesh;

    /// Whether the grass beside a road hangs over something: bridges have none.
    bool hangs(const LaneEdges& a, const LaneEdges& b) const {
        for (const glm::dvec3 p : {a.inner.position, a.outer.position, b.inner.position, b.outer.position,
                                   (a.inner.position + b.outer.position) / 2.0})
            if (build.ground.height(glm::dvec2(p)) < p.z - kBridge) return true;
        return false;
    }

    /// Along one lane, from one station to the next. Returns whether there is anything.
    bool lane_piece(size_t l, size_t i) {
        const RoadLane& lane = section.lanes[l];
        const LaneEdges &a = cut.rows[i][l], &b = cut.rows[i + 1][l];
        const bool is_left = lane.id > 0, driven = is_driven(lane.type);
        const double width =
            glm::distance(a.inner.position, a.outer.position) + glm::distance(b.inner.position, b.outer.position);
        if (width < 1e-3) return false;
        if (!driven && road.junction != kNoRoad) {
            const glm::dvec3 middle = (a.inner.position + a.outer.position + b.inner.position + b.outer.position) / 4.0;
            if (is_driven_over(build, cut.road, middle, kInsideSurface)) return false;
        }
        const RoadMaterial stuff = stuff_of(lane.type, is_verge(section, lane, cut.stations[i]));
        if (stuff == RoadMaterial::Grass && hangs(a, b)) return false;
        // Grass lies a little lower, so that where roads meet none of it shows through the lanes of another.
        const double lift = stuff == RoadMaterial::Grass ? -kGrassDrop : driven && road.junction != kNoRoad ? kLift : 0;
        const auto part = [&](RoadMaterial of, double from, double to, double lift_by) {
            const RoadPoint i0 = between(a.inner, a.outer, from), i1 = between(b.inner, b.outer, from);
            const RoadPoint o0 = between(a.inner, a.outer, to), o1 = between(b.inner, b.outer, to);
            if (is_left)
                strip(mesh, of, i0, i1, o0, o1, lift_by);
            else
                strip(mesh, of, o0, o1, i0, i1, lift_by);
        };
        // The inner edge's neighbour lies towards the centre.
        const size_t inner = is_left ? l + 1 : l - 1;
        const LaneEdges &n0 = cut.rows[i][inner], &n1 = cut.rows[i + 1][inner];
        const double rise = std::max(glm::dot(a.inner.position - n0.outer.position, a.inner.up),
                                     glm::dot(b.inner.position - n1.outer.position, b.inner.up));
        const double stone = rise > kStep && lane.type != LaneType::Curb ? std::min(1.0, 2 * kKerbWidth / width) : 0;
        if (stone > 0) part(RoadMaterial::Kerb, 0, stone, 0);
        if (stone < 1) part(stuff, stone, 1, lift);
        step_face(n0.outer, n1.outer, a.inner, b.inner, is_left);
        return true;
    }

    /// A vertical face where two edges that should meet have different heights: first the one nearer to the centre.
    void step_face(const RoadPoint& n0, const RoadPoint& n1, const RoadPoint& e0, const RoadPoint& e1, bool is_left) {
        const double rise = std::max(std::abs(e0.position.z - n0.position.z), std::abs(e1.position.z - n1.position.z));
        if (rise < 1e-3) return;
        const bool up = e0.position.z + e1.position.z > n0.position.z + n1.position.z;
        const RoadPoint &low0 = up ? n0 : e0, &low1 = up ? n1 : e1, &high0 = up ? e0 : n0, &high1 = up ? e1 : n1;
        // It looks to where it is low: towards the centre where it rises outwards.
        if (is_left == up)
            mesh.quad(RoadMaterial::Kerb, low0.position, low1.position, high1.position, high0.position);
        else
            mesh.quad(RoadMaterial::Kerb, low1.position, low0.position, high0.position, high1.position);
    }

    /// From an edge down into the ground; the deck of a bridge ends before.
    glm::dvec3 foot(const RoadPoint& p) const {
        const double ground = build.ground.height(glm::dvec2(p.position));
        const double z = ground < p.position.z - kBridge ? p.position.z - kDeck : std::min(ground, p.position.z) - 0.1;
        return {p.position.x, p.position.y, z};
    }

    /// The sides of a piece between its outermost lanes, and what bridges show from below.
    void sides(size_t first, size_t last, size_t i) {
        const RoadPoint &l0 = cut.rows[i][first].outer, &l1 = cut.rows[i + 1][first].outer,
                        &r0 = cut.rows[i][last].outer, &r1 = cut.rows[i + 1][last].outer;
        const auto stuff = [&](size_t l) {
            return section.lanes[l].type == LaneType::Sidewalk || section.lanes[l].type == LaneType::Curb
                       ? RoadMaterial::Kerb
                       : RoadMaterial::Grass;
        };
        const bool bridge =
            hangs(cut.rows[i][first], cut.rows[i + 1][first]) || hangs(cut.rows[i][last], cut.rows[i + 1][last]);
        mesh.quad(bridge ? RoadMaterial::Concrete : stuff(first), foot(l1), foot(l0), l0.position, l1.position);
        mesh.quad(bridge ? RoadMaterial::Concrete : stuff(last), foot(r0), foot(r1), r1.position, r0.position);
        if (bridge) mesh.quad(RoadMaterial::Concrete, foot(l0), foot(l1), foot(r1), foot(r0));
    }

    void pieces(size_t i) {
        size_t first = section.lanes.size(), last = 0;
        for (size_t l = 0; l < section.lanes.size(); ++l)
            if (section.lanes[l].id == 0 || lane_piece(l, i)) first = std::min(first, l), last = l;
        sides(first, last, i);
    }

    /// Across the road's own end, where nothing follows.
    void end(size_t i, bool at_start) {
        for (size_t l = 0; l < section.lanes.size(); ++l) {
            const LaneEdges& edges = cut.rows[i][l];
            const RoadPoint &right = section.lanes[l].id > 0 ? edges.inner : edges.outer,
                            &left = section.lanes[l].id > 0 ? edges.outer : edges.inner;
            if (at_start)
                mesh.quad(RoadMaterial::Grass, foot(left), foot(right), right.position, left.position);
            else
                mesh.quad(RoadMaterial::Grass, foot(right), foot(left), left.position, right.position);
        }
    }
};

}  // namespace

std::vector<CutSection> cut_roads(const RoadNetwork& network, double chord) {
    std::vector<CutSection> cuts;
    size_t edges = 0;
    for (uint32_t r = 0; r < network.roads.size(); ++r) {
        const Road& road = network.roads[r];
        for (uint32_t s = 0; s < road.sections.size(); ++s) {
            const LaneSection& section = road.sections[s];
            CutSection cut{r, s, road_stations(road, section, chord, kLongestStation), {}};
            edges += cut.stations.size() * section.lanes.size();
            if (edges > kMaxEdges)
                throw Error("the roads are too finely divided to be built: more than " + std::to_string(kMaxEdges) +
                            " lane edges");
            spend(cut.stations.size() * section.lanes.size() * sizeof(LaneEdges));
            for (const double at : cut.stations) {
                std::vector<LaneEdges> row;
                for (const RoadLane& lane : section.lanes)
                    row.push_back(
                        {lane_point(road, section, lane.id, at, 0), lane_point(road, section, lane.id, at, 1)});
                cut.rows.push_back(std::move(row));
            }
            cuts.push_back(std::move(cut));
        }
    }
    return cuts;
}

bool is_verge(const LaneSection& section, const RoadLane& lane, double s) {
    constexpr double kWide = 1;  // m
    const bool outermost = lane.id == section.leftmost() || lane.id == section.rightmost();
    return lane.type == LaneType::Border && outermost && stated_width(section, lane, s) > kWide;
}

bool is_driven_over(const RoadBuild& build, uint32_t road, glm::dvec3 point, double margin) {
    const bool in_junction = build.network.roads[road].junction != kNoRoad;
    const glm::dvec3 at = build.network.to_world(point);
    const auto place = build.lanes.nearest(at, 8, [&](const Lane& lane) {
        return lane.road != road && is_driven(lane.type) && (in_junction || lane.in_junction);
    });
    if (!place) return false;
    const LanePose pose = build.lanes.pose(place->lane, place->along);
    const bool beyond = place->along <= 0 || place->along >= build.lanes.lanes()[place->lane].length;
    return !beyond && std::abs(place->offset) < pose.width / 2 - margin &&
           std::abs(glm::dot(at - pose.position, pose.up)) < 0.5;
}

bool is_on_road(const RoadBuild& build, glm::dvec3 point, double margin) {
    const glm::dvec3 at = build.network.to_world(point);
    const auto place = build.lanes.nearest(at, 12);
    if (!place) return false;
    const LanePose pose = build.lanes.pose(place->lane, place->along);
    const double half = pose.width / 2 + margin;
    // Beyond the end of a lane the centre is farther away than the offset says.
    return std::abs(place->offset) < half && std::abs(at.y - pose.position.y) < 3 &&
           std::hypot(at.x - pose.position.x, at.z - pose.position.z) < half + kBeyondLane;
}

BodyFrame frame_at(const Road& road, double s, double t, double z_offset) {
    const RoadPoint point = surface_point(road, s, t);
    // Things stand upright, whatever the slope.
    const glm::dvec3 forward{std::cos(point.heading), std::sin(point.heading), 0};
    return {point.position + glm::dvec3(0, 0, z_offset), forward, {-forward.y, forward.x, 0}, {0, 0, 1}};
}

void build_surfaces(RoadBuild& build, const std::vector<CutSection>& cuts) {
    RoadMesh mesh(build.network);
    for (const CutSection& cut : cuts) {
        SectionBuilder builder{build, cut, build.network.roads[cut.road],
                               build.network.roads[cut.road].sections[cut.section], mesh};
        double begun = cut.stations.front();
        for (size_t i = 0; i + 1 < cut.stations.size(); ++i) {
            builder.pieces(i);
            if (cut.stations[i + 1] - begun > kPiece) {
                mesh.place(build.scene, build.materials, "road " + builder.road.id);
                begun = cut.stations[i + 1];
            }
        }
        const Road& road = builder.road;
        if (cut.section == 0 && road.predecessor.to == RoadLink::To::Nothing) builder.end(0, true);
        if (cut.section + 1 == road.sections.size() && road.successor.to == RoadLink::To::Nothing)
            builder.end(cut.stations.size() - 1, false);
        mesh.place(build.scene, build.materials, "road " + builder.road.id);
    }
}

}  // namespace vesper::roads
