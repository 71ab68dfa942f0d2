// The parts of building a lit road. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include "roads/ground.h"
#include "roads/lit_roads.h"
#include "roads/road_mesh.h"
#include "roads/road_surface.h"

namespace vesper::roads {

constexpr double kMarkHeight = 0.006;  ///< m of paint above the road; reversed depth resolves this at any distance

/// State of the construction of a scene.
struct RoadBuild {
    const RoadNetwork& network;
    const LaneGraph& lanes;
    const LitRoadOptions& options;
    scene::Scene scene{};
    RoadMaterials materials{scene};
    Ground ground{};
    std::vector<std::string> notes{};
    std::map<std::string, SignalPhase> phases{};
    std::map<std::string, size_t> light_numbers{};  ///< the last one given to traffic lights that share an id
    size_t lights_renamed = 0;
    std::map<std::string, size_t> dark_poles{};  ///< poles that are no lamps, by name
    size_t lamps_by_height = 0;                  ///< poles without a name that are lamps
    std::map<std::string, size_t> shapeless{};   ///< stencils whose paint is not known, by name
};

/// One lane at one station.
struct LaneEdges {
    RoadPoint inner, outer;
};

/// A lane section cut at stations: lane by lane as in the section, the centre's edges both at the lane offset.
struct CutSection {
    uint32_t road = 0, section = 0;
    std::vector<double> stations;
    std::vector<std::vector<LaneEdges>> rows;  ///< of each station, of each lane
};

std::vector<CutSection> cut_roads(const RoadNetwork& network, double chord);

/// True if a border lane is the grass beside the road.
bool is_verge(const LaneSection& section, const RoadLane& lane, double s);
/// True if a point of a road lies on a driven lane of another road, at its height, more than `margin` m inside, and one
/// of the two roads belongs to a junction.
bool is_driven_over(const RoadBuild& build, uint32_t road, glm::dvec3 point, double margin);
/// True if a point lies on a driven lane, or within `margin` m of one.
bool is_on_road(const RoadBuild& build, glm::dvec3 point, double margin);

/// "name (3), other (1)", the first `most`.
std::string listed(const std::map<std::string, size_t>& names, size_t most = 8);

/// A frame at (s, t), z_offset m above the surface, x along the road.
BodyFrame frame_at(const Road& road, double s, double t, double z_offset);

Ground make_ground(const RoadNetwork& network, const std::vector<CutSection>& cut, double margin);
void build_surfaces(RoadBuild&, const std::vector<CutSection>& cut);
void build_marks(RoadBuild&, const std::vector<CutSection>& cut);
void build_ground(RoadBuild&);
void build_objects(RoadBuild&);
void build_signals(RoadBuild&);
void build_street_lamps(RoadBuild&);
void build_cameras(RoadBuild&);

}  // namespace vesper::roads
