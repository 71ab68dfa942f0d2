// From a road network to a night scene: the table of contents. SPDX-License-Identifier: MIT
#include "roads/lit_roads.h"

#include <cmath>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "roads/lit_road_parts.h"

namespace vesper::roads {
namespace {

constexpr double kMaxDrawn = 300'000;  // m of road

void check_options(const LitRoadOptions& o) {
    if (!(o.chord >= 0.001 && o.chord <= 1)) throw Error("lit roads: chord must be from 0.001 to 1 m");
    if (!(o.margin >= 10 && o.margin <= 5000)) throw Error("lit roads: margin must be from 10 to 5000 m");
    if (!(o.ambient >= 0 && o.sky >= 0 && std::isfinite(o.ambient) && std::isfinite(o.sky)))
        throw Error("lit roads: ambient and sky must not be negative");
    check_signal_time(o.signal_time);
    check_street_lamps(o.lamps);
}

void count_triangles(RoadBuild& build) {
    size_t triangles = 0, lamps = 0;
    for (const scene::Mesh& mesh : build.scene.meshes)
        for (const scene::Primitive& primitive : mesh.primitives) triangles += primitive.indices.size() / 3;
    for (const scene::Node& node : build.scene.nodes) lamps += node.lamp != scene::kNone;
    build.notes.push_back("scene: " + std::to_string(triangles) + " triangles, " + std::to_string(lamps) + " lamps, " +
                          std::to_string(build.scene.cameras.size()) + " cameras");
}

/// Names of numbers and persons, not of things.
bool says_nothing_to_see(const std::string& unread) {
    return unread.starts_with("header@") || unread == "connection@id" || unread.ends_with("@name");
}

}  // namespace

std::string listed(const std::map<std::string, size_t>& names, size_t most) {
    std::string text;
    size_t number = 0;
    for (const auto& [name, count] : names) {
        if (number++ == most) return text + " and " + std::to_string(names.size() - most) + " more";
        text += (text.empty() ? "" : ", ") + one_line(name, 80) + " (" + std::to_string(count) + ")";
    }
    return text;
}

LitRoads lit_roads(const RoadNetwork& network, const LitRoadOptions& options) {
    const Budget budget("building roads");
    check_options(options);
    double length = 0;
    for (const Road& road : network.roads) length += road.sections.empty() ? 0 : road.length;
    if (length <= 0) throw Error("the network has no lanes to build");
    if (length > kMaxDrawn)
        throw Error("the network has " + std::to_string(std::lround(length / 1000)) +
                    " km of roads: scenes are built of up to " + std::to_string(std::lround(kMaxDrawn / 1000)) + " km");

    const LaneGraph lanes(network);
    RoadBuild build{network, lanes, options};
    build.scene.name = network.name;
    build.scene.ambient_illuminance = static_cast<float>(options.ambient);
    build.scene.sky_luminance = static_cast<float>(options.sky);
    build.notes.push_back("roads: " + std::to_string(network.roads.size()) + ", " +
                          std::to_string(std::lround(length)) + " m, " + std::to_string(network.junctions.size()) +
                          " junctions, " + std::to_string(lanes.lanes().size()) + " lanes");

    const std::vector<CutSection> cut = cut_roads(network, options.chord);
    build.ground = make_ground(network, cut, options.margin);
    build_surfaces(build, cut);
    build_marks(build, cut);
    build_ground(build);
    build_objects(build);
    build_signals(build);
    build_street_lamps(build);
    build_cameras(build);
    count_triangles(build);
    std::map<std::string, size_t> unread = network.unread;
    std::erase_if(unread, [](const auto& each) { return says_nothing_to_see(each.first); });
    if (!unread.empty()) build.notes.push_back("not shown, as nothing reads it: " + listed(unread, 16));
    return {std::move(build.scene), std::move(build.notes), std::move(build.phases)};
}

}  // namespace vesper::roads
