// Cameras, and the driver's way along the lanes. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "photometry/standard_lamps.h"
#include "roads/road_lamps.h"
#include "scene/colour.h"

namespace vesper::roads {
namespace {

constexpr float kView = 0.6435f;        // rad, 36.87 degrees, as the Rivoli driver's
constexpr double kFastest = 130 / 3.6;  // m/s, of allowed_speed
constexpr double kSideways = 2;         // m/s^2 in bends
constexpr double kDriverBraking = 1.5;  // m/s^2
constexpr double kKeyEvery = 0.1;       // s
constexpr double kLongestDrive = 120;   // s
// Headlamps of a car, from the middle of its front axle on the road, m.
constexpr double kLampHeight = 0.65, kLampSide = 0.6, kLampAhead = 0.7;
constexpr double kEyeBehind = 1.2, kEyeSide = 0.37;  // m, of the driver's eye

struct WayPoint {
    LanePose pose;
    double speed = 0;
};

/// Where the longest drive begins: lanes nothing leads to first, otherwise all of them.
std::vector<uint32_t> longest_way(const LaneGraph& graph) {
    constexpr size_t kTries = 200;
    std::vector<uint32_t> best;
    double longest = -1;
    const auto lanes = graph.lanes();
    for (const bool only_entries : {true, false}) {
        size_t tries = 0;
        for (uint32_t i = 0; i < lanes.size() && tries < kTries; ++i) {
            if (!is_driven(lanes[i].type) || (only_entries && !lanes[i].predecessors.empty())) continue;
            ++tries;
            std::vector<uint32_t> way = graph.long_route(i);
            double length = 0;
            for (const uint32_t lane : way) length += lanes[lane].length;
            if (length > longest) longest = length, best = std::move(way);
        }
        if (!best.empty()) break;
    }
    return best;
}

/// A pose every metre, and how fast a careful driver is there.
std::vector<WayPoint> drive_along(const LaneGraph& graph, const std::vector<uint32_t>& way) {
    std::vector<WayPoint> points;
    double begin = 0, limit = 0;
    for (const uint32_t index : way) {
        const Lane& lane = graph.lanes()[index];
        double along = begin;
        for (; along < lane.length; along += 1) {
            WayPoint point{graph.pose(index, along)};
            limit = allowed_speed(lane, point.pose, limit);
            point.speed = std::min(limit, std::sqrt(kSideways / std::max(std::abs(point.pose.curvature), 1e-4)));
            points.push_back(point);
        }
        begin = along - lane.length;
        if (static_cast<double>(points.size()) > kLongestDrive * kFastest) break;
    }
    for (size_t i = points.size(); i-- > 1;)
        points[i - 1].speed =
            std::min(points[i - 1].speed, std::sqrt(points[i].speed * points[i].speed + 2 * kDriverBraking));
    for (size_t i = 1; i < points.size(); ++i)
        points[i].speed =
            std::min(points[i].speed, std::sqrt(points[i - 1].speed * points[i - 1].speed + 2 * kDriverBraking));
    return points;
}

glm::quat rotation_of(glm::dvec3 forward, glm::dvec3 up) {
    return glm::quat(glm::normalize(glm::quat_cast(glm::dmat3(glm::cross(forward, up), up, -forward))));
}

void animate(scene::Scene& scene, uint32_t node, const std::vector<WayPoint>& points) {
    scene::Channel place{.node = node, .path = scene::Channel::Path::Translation},
        turn{.node = node, .path = scene::Channel::Path::Rotation};
    double at = 0;
    glm::quat before(1, 0, 0, 0);
    for (double time = 0; time < kLongestDrive; time += kKeyEvery) {
        const auto i = static_cast<size_t>(at);
        if (i + 1 >= points.size()) break;
        const double f = at - std::floor(at);
        const LanePose &a = points[i].pose, &b = points[i + 1].pose;
        const glm::dvec3 position = glm::mix(a.position, b.position, f);
        glm::quat rotation =
            rotation_of(glm::normalize(glm::mix(a.forward, b.forward, f)), glm::normalize(glm::mix(a.up, b.up, f)));
        if (glm::dot(rotation, before) < 0) rotation = -rotation;
        before = rotation;
        place.times.push_back(static_cast<float>(time));
        place.values.emplace_back(glm::vec3(position), 0);
        turn.times.push_back(static_cast<float>(time));
        turn.values.emplace_back(rotation.x, rotation.y, rotation.z, rotation.w);
        at += glm::mix(points[i].speed, points[i + 1].speed, f) * kKeyEvery;  // points are 1 m apart
    }
    if (place.times.size() < 2) return;
    scene.channels.push_back(place);
    scene.channels.push_back(turn);
}

void add_camera(scene::Scene& scene, const std::string& name, scene::Node node) {
    node.name = name;
    node.camera = static_cast<uint32_t>(scene.cameras.size());
    scene.cameras.push_back({.name = name, .vertical_fov = kView});
    scene.nodes.push_back(std::move(node));
}

void look(scene::Scene& scene, const std::string& name, glm::dvec3 from, glm::dvec3 at) {
    const glm::dvec3 forward = glm::normalize(at - from),
                     right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
    scene::Node node;
    node.translation = glm::vec3(from);
    node.rotation = rotation_of(forward, glm::cross(right, forward));
    add_camera(scene, name, node);
}

void add_headlamps(RoadBuild& build, uint32_t car) {
    scene::Scene& scene = build.scene;
    scene::Lamp lamp{.name = "low beam", .kind = scene::Lamp::Kind::Measured};
    lamp.intensity = 1;
    lamp.colour = scene::colour_of_temperature(4000);
    lamp.distribution = static_cast<uint32_t>(scene.distributions.size());
    scene.distributions.push_back(photometry::standard_lamp("low-beam"));
    scene.distributions.back().name = "low beam";
    for (const char* side : {"left", "right"}) {
        scene::Node node{.name = std::string("car_ego/headlamp_") + side, .parent = car};
        node.translation = glm::vec3((side[0] == 'l' ? -1 : 1) * kLampSide, kLampHeight, -kLampAhead);
        node.lamp = static_cast<uint32_t>(scene.lamps.size());
        scene.nodes.push_back(node);
    }
    scene.lamps.push_back(lamp);
}

}  // namespace

void build_cameras(RoadBuild& build) {
    scene::Scene& scene = build.scene;
    scene::Bounds bounds;
    for (const Lane& lane : build.lanes.lanes())
        for (const LanePose& pose : lane.poses) bounds.add(glm::vec3(pose.position));
    const std::vector<uint32_t> way = longest_way(build.lanes);
    if (!way.empty()) {
        const std::vector<WayPoint> points = drive_along(build.lanes, way);
        const LanePose start = points.front().pose;
        const auto car = static_cast<uint32_t>(scene.nodes.size());
        scene::Node node{.name = "car_ego"};
        node.translation = glm::vec3(start.position);
        node.rotation = rotation_of(start.forward, start.up);
        scene.nodes.push_back(node);
        animate(scene, car, points);
        const bool right_hand = build.network.roads[build.lanes.lanes()[way[0]].road].right_hand;
        scene::Node eye{.parent = car};
        eye.translation = glm::vec3(right_hand ? -kEyeSide : kEyeSide, build.options.eye_height, kEyeBehind);
        add_camera(scene, "driver", eye);
        if (build.options.headlamps) add_headlamps(build, car);
        // Beside the road, looking along it.
        const LanePose ahead = points[std::min<size_t>(points.size() - 1, 40)].pose;
        const glm::dvec3 side = start.left() * (right_hand ? -1.0 : 1.0);
        look(scene, "roadside", start.position + side * (start.width / 2 + 2) + glm::dvec3(0, 1.7, 0),
             ahead.position + glm::dvec3(0, 0.8, 0));
        const double longest = scene::animation_length(scene);
        build.notes.push_back("driver: " + std::to_string(points.size()) + " m over " + std::to_string(way.size()) +
                              " lanes in " + std::to_string(std::lround(longest)) + " s");
    }
    if (bounds.empty()) bounds.add(glm::vec3(0)), bounds.add(glm::vec3(10));
    // From above, looking down at 45 degrees on the middle of all lanes.
    const glm::dvec3 middle = glm::dvec3(bounds.low + bounds.high) / 2.0;
    const double size = std::clamp(glm::length(glm::dvec3(bounds.high - bounds.low)) / 2, 15.0, 300.0);
    look(scene, "overview", middle + glm::dvec3(0, size, size * 1.2), middle);
}

}  // namespace vesper::roads
