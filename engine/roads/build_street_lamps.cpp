// Street lamps along roads. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "photometry/standard_lamps.h"
#include "roads/road_lamps.h"
#include "scene/colour.h"

namespace vesper::roads {
namespace {

constexpr size_t kMaxStreetLamps = 20'000;
constexpr double kHead = 0.6, kHeadWidth = 0.3;  // m, of the luminaire; its opening is that
constexpr double kVerge = 0.7;                   // m from the edge of the road to the pole
constexpr double kDesignHeight = 8;              // m, for which the standard luminaire gives its 18 lx
constexpr double kOwnSection = 30;               // m along a road that cannot lead over itself
constexpr double kSpacing = 30;                  // m
constexpr double kColourTemperature = 3000;      // K

/// The light all street lamps of one height share; higher ones are stronger, so that the road stays as bright.
uint32_t lamp_light(RoadBuild& build, double height) {
    const std::optional<photometry::Distribution>& luminaire = build.options.luminaire;
    const auto factor =
        static_cast<float>(luminaire ? 1.0 : std::max(1.0, height * height / (kDesignHeight * kDesignHeight)));
    for (uint32_t i = 0; i < build.scene.lamps.size(); ++i)
        if (build.scene.lamps[i].name == "street lamp" && build.scene.lamps[i].intensity == factor) return i;
    scene::Lamp lamp{.name = "street lamp", .kind = scene::Lamp::Kind::Measured};
    lamp.intensity = factor;
    lamp.colour = scene::colour_of_temperature(kColourTemperature);
    lamp.opening.length = kHead, lamp.opening.width = kHeadWidth;
    lamp.distribution = static_cast<uint32_t>(build.scene.distributions.size());
    for (uint32_t i = 0; i < build.scene.distributions.size(); ++i)
        if (build.scene.distributions[i].name == "street lamp") lamp.distribution = i;
    if (lamp.distribution == build.scene.distributions.size()) {
        build.scene.distributions.push_back(luminaire ? *luminaire : photometry::standard_lamp("street-lamp"));
        build.scene.distributions.back().name = "street lamp";
    }
    build.scene.lamps.push_back(lamp);
    return static_cast<uint32_t>(build.scene.lamps.size() - 1);
}

struct Row {
    bool left = false;
    double first = 0;
};

/// The outermost border that lamps stand behind: of lanes that are paved.
double edge_of(const Road& road, const LaneSection& section, int side, double s) {
    int last = 0;
    for (int id = side; section.find(id); id += side) {
        const LaneType type = section.find(id)->type;
        if (is_driven(type)) last = id;
        if (last == 0) continue;
        if ((!is_level_with_road(type) && type != LaneType::Curb) || is_verge(section, *section.find(id), s))
            break;  // in front of pavements and grass
        last = id;
    }
    return lane_border(road, section, last, s);
}

std::vector<Row> rows_of(const StreetLampOptions& options, const Road& road, double width) {
    const bool both = options.side == LampSide::Both || (options.side == LampSide::Auto && width > 12);
    if (both) return {{true, 0.5}, {false, 0.5}};
    if (options.side == LampSide::Alternating) return {{true, 0.25}, {false, 0.75}};
    return {{options.side == LampSide::Auto ? !road.right_hand : options.side == LampSide::Left, 0.5}};
}

/// World height of the highest point of each lane, m.
std::vector<double> highest_points(const LaneGraph& graph) {
    std::vector<double> highest;
    for (const Lane& lane : graph.lanes()) {
        highest.push_back(lane.poses.front().position.y);
        for (const LanePose& pose : lane.poses) highest.back() = std::max(highest.back(), pose.position.y);
    }
    return highest;
}

/// A place beside a road.
struct Beside {
    uint32_t road = 0;
    double s = 0;
    glm::dvec3 foot{0};
};

/// Whether a lane is of the cross section that a place lies beside: a tilted one rises above it, and is no bridge.
bool is_own_section(const RoadBuild& build, const Beside& beside, const Lane& lane, double along) {
    if (lane.road != beside.road) return false;
    const LaneSection& section = build.network.roads[lane.road].sections[lane.section];
    const double s = lane.forwards ? section.s + along : section.end - along;
    return std::abs(s - beside.s) < kOwnSection;
}

/// Whether a bridge is in the lamp's way.
bool is_below_road(const RoadBuild& build, const std::vector<double>& highest, const Beside& beside, double height) {
    const glm::dvec3 foot = beside.foot;
    for (double up = 4; up < height + 4; up += 3) {
        const glm::dvec3 at = build.network.to_world(foot + glm::dvec3(0, 0, up));
        const auto place = build.lanes.nearest(at, 20, [&](const Lane& lane) {
            return is_driven(lane.type) &&
                   highest[static_cast<size_t>(&lane - build.lanes.lanes().data())] > at.y - up + 3;
        });
        if (!place || is_own_section(build, beside, build.lanes.lanes()[place->lane], place->along)) continue;
        const LanePose pose = build.lanes.pose(place->lane, place->along);
        if (std::abs(place->offset) < pose.width / 2 + 5 && pose.position.y > at.y - up + 3 &&
            pose.position.y < at.y - up + height + 2)
            return true;
    }
    return false;
}

struct LampCount {
    size_t built = 0, left_out = 0;
};

void light_road(RoadBuild& build, uint32_t index, double spacing, const std::vector<double>& highest,
                LampCount& count) {
    const Road& road = build.network.roads[index];
    const StreetLampOptions& options = build.options.lamps;
    const double middle = road.length / 2;
    const LaneSection& section = road.sections[road.section_at(middle)];
    const double width = edge_of(road, section, 1, middle) - edge_of(road, section, -1, middle);
    const double height = options.height > 0 ? options.height : std::clamp(width / 2 + 4, kDesignHeight, 12.0);
    for (const Row& row : rows_of(options, road, width)) {
        const bool alternating = options.side == LampSide::Alternating;
        const double pitch = spacing * (alternating ? 2 : 1);
        const int steps = std::max(1, static_cast<int>(std::lround(road.length / pitch)));
        for (int k = 0; k < steps; ++k) {
            const double s = road.length * (k + row.first) / steps;
            const LaneSection& here = road.sections[road.section_at(s)];
            const int side = row.left ? 1 : -1;
            const double t = edge_of(road, here, side, s) + side * kVerge;
            BodyFrame frame = frame_at(road, s, t, 0);
            if (is_on_road(build, frame.origin, 0.3) ||
                is_below_road(build, highest, {index, s, frame.origin}, height)) {
                ++count.left_out;
                continue;
            }
            // It stands on what is there: a pavement, or the ground.
            frame.origin.z =
                std::max(frame.origin.z - 0.3, std::min(frame.origin.z, build.ground.height(glm::dvec2(frame.origin))));
            if (++count.built > kMaxStreetLamps) return;
            add_street_lamp(build, frame, height, -side);
        }
    }
}

}  // namespace

scene::Node node_at(const RoadBuild& build, const std::string& name, glm::dvec3 position, glm::dvec3 x, glm::dvec3 y,
                    glm::dvec3 z) {
    scene::Node node{.name = name};
    node.translation = glm::vec3(build.network.to_world(position));
    const auto turned = [](glm::dvec3 d) { return glm::normalize(RoadNetwork::direction_to_world(d)); };
    node.rotation = glm::quat(glm::normalize(glm::quat_cast(glm::dmat3(turned(x), turned(y), turned(z)))));
    return node;
}

void add_street_lamp(RoadBuild& build, const BodyFrame& frame, double height, int towards) {
    const double overhang = build.options.lamps.overhang * towards;
    size_t number = 0;
    for (auto node = build.scene.nodes.rbegin(); node != build.scene.nodes.rend(); ++node)
        if (node->name.starts_with("street_lamp_") && node->name.ends_with("/light")) {
            number = std::stoul(node->name.substr(12)) + 1;
            break;
        }
    char name[40];
    std::snprintf(name, sizeof name, "street_lamp_%03zu", number);
    RoadMesh mesh(build.network);
    add_cylinder(mesh, RoadMaterial::PoleSteel, frame.moved(0, 0, -0.3), 0.09, height + 0.4, 0.05);
    add_box(mesh, RoadMaterial::PoleSteel, frame.moved(0, overhang / 2, height + 0.06), 0.07, std::abs(overhang), 0.07);
    add_box(mesh, RoadMaterial::Luminaire, frame.moved(0, overhang, height + 0.02), kHead, kHeadWidth, 0.1);
    mesh.place(build.scene, build.materials, name);
    // The luminaire's frame: -Z down, C0 (+X) along the road, C90 (+Y) towards it.
    const double side = towards;
    scene::Node node = node_at(build, std::string(name) + "/light", frame.at(0, overhang, height), frame.x * side,
                               frame.y * side, frame.z);
    node.lamp = lamp_light(build, height);
    build.scene.nodes.push_back(node);
}

void check_street_lamps(const StreetLampOptions& lamps) {
    const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
    const double spacing = lamps.spacing.value_or(kSpacing);
    if (spacing > 0 && spacing < 2)
        throw Error("street lamps every " + std::to_string(spacing) + " m: at least 2 m are expected");
    if (!within(spacing, 0, 1000)) throw Error("street lamps: the spacing must be from 0 to 1000 m");
    if (lamps.height != 0 && !within(lamps.height, 2, 60))
        throw Error("street lamps: the height must be from 2 to 60 m");
    if (!within(lamps.overhang, 0.1, 20)) throw Error("street lamps: the overhang must be from 0.1 to 20 m");
}

void build_street_lamps(RoadBuild& build) {
    const std::optional<double>& wanted = build.options.lamps.spacing;
    const double spacing = wanted.value_or(kSpacing);
    if (spacing == 0) return;
    const bool has_own = std::any_of(build.scene.lamps.begin(), build.scene.lamps.end(),
                                     [](const scene::Lamp& lamp) { return lamp.name == "street lamp"; });
    if (has_own && !wanted) return;
    LampCount count;
    const std::vector<double> highest = highest_points(build.lanes);
    for (uint32_t r = 0; r < build.network.roads.size(); ++r)
        if (const Road& road = build.network.roads[r];
            road.junction == kNoRoad && !road.sections.empty() && road.length > 5)
            light_road(build, r, spacing, highest, count);
    if (count.built > kMaxStreetLamps)
        build.notes.push_back("street lamps: more than " + std::to_string(kMaxStreetLamps) + ": the rest is left out");
    build.notes.push_back("street lamps: " + std::to_string(std::min(count.built, kMaxStreetLamps)) + ", every " +
                          std::to_string(std::lround(spacing)) + " m");
    if (count.left_out > 0)
        build.notes.push_back("street lamps left out on lanes and below bridges: " + std::to_string(count.left_out));
}

}  // namespace vesper::roads
