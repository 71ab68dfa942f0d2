#include "road_world.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.h"
#include "io/atomic_file.h"
#include "plain_car.h"
#include "roads/esmini_run.h"
#include "roads/lit_roads.h"
#include "roads/opendrive.h"

namespace vesper {
namespace {

constexpr double kUsualSpeed = 50 / 3.6;  // m/s, where a road states none
constexpr size_t kMostCourses = 64, kTraffic = 8;
constexpr double kTrafficGap = 60;        // m

// A way over lanes as one line.
std::optional<Course> course_of(const LaneGraph& graph, const std::vector<uint32_t>& way) {
    std::vector<glm::dvec3> points;
    double width = 3.5, speed = 0;
    for (const uint32_t index : way) {
        const Lane& lane = graph.lanes()[index];
        for (const LanePose& pose : lane.poses)
            if (points.empty() || std::hypot(pose.position.x - points.back().x, pose.position.z - points.back().z) > 0.2) points.push_back(pose.position);
        if (speed == 0) speed = lane.speed_limit, width = std::max(lane.poses.front().width, 2.0);
    }
    if (points.size() < 2) return std::nullopt;
    const auto& next = graph.lanes()[way.back()].successors;
    const bool closed = std::find(next.begin(), next.end(), way.front()) != next.end();
    if (closed && std::hypot(points.front().x - points.back().x, points.front().z - points.back().z) < 0.2) points.pop_back();
    return Course(graph.lanes()[way.front()].name, std::move(points), width, speed > 0 ? speed : kUsualSpeed, closed);
}

// Ways from every lane that none leads to, and from the first of what these leave out; the longest first.
std::vector<Course> courses_of(const LaneGraph& graph) {
    std::vector<bool> passed(graph.lanes().size(), false);
    std::vector<Course> courses;
    const auto take = [&](uint32_t from) {
        const std::vector<uint32_t> way = graph.long_route(from);
        for (const uint32_t lane : way) passed[lane] = true;
        if (const auto course = way.empty() ? std::nullopt : course_of(graph, way)) courses.push_back(*course);
    };
    for (const bool entries : {true, false})
        for (uint32_t i = 0; i < graph.lanes().size() && courses.size() < kMostCourses; ++i) {
            const Lane& lane = graph.lanes()[i];
            if (lane.type == LaneType::Driving && !passed[i] && (!entries || lane.predecessors.empty())) take(i);
        }
    std::stable_sort(courses.begin(), courses.end(), [](const Course& a, const Course& b) { return a.length() > b.length(); });
    return courses;
}

VehicleLamps lamps_at(const RunEntity& e, double time) {
    const auto lit = [&](RunLamp lamp) { return lamp_at(e, lamp, time).level > 0.5; };
    const bool low = lit(RunLamp::LowBeam), high = lit(RunLamp::HighBeam);
    return {.low = low, .high = high, .tail = low || high || lit(RunLamp::FogRear), .brake = lit(RunLamp::Brake), .left = lit(RunLamp::IndicatorLeft), .right = lit(RunLamp::IndicatorRight)};
}

RecordedMover recording_of(const RunEntity& e, const std::string& node, const RoadNetwork& network) {
    RecordedMover r{.node = node, .length = e.length > 0 ? e.length : 4.4, .middle = e.centre.x, .poses = {}};
    for (const RunPose& p : e.poses)
        r.poses.push_back({p.time, network.to_world(p.position), p.heading - std::numbers::pi / 2, -p.pitch, p.roll, p.speed, lamps_at(e, p.time)});
    return r;
}

PlainBody body_of(const RunEntity& e) {
    using Kind = RunEntity::Kind;
    const bool vehicle = e.kind == Kind::Car || e.kind == Kind::Truck || e.kind == Kind::Bus || e.kind == Kind::Motorcycle;
    const glm::dvec3 usual = e.kind == Kind::Truck || e.kind == Kind::Bus ? glm::dvec3(10, 2.5, 3) : vehicle ? glm::dvec3(4.4, 1.8, 1.5) : glm::dvec3(0.5, 0.6, 1.75);
    PlainBody body{.size = usual, .centre = {vehicle ? usual.x * 0.3 : 0, 0, usual.z / 2}, .lamps = vehicle};
    if (e.length > 0 && e.width > 0 && e.height > 0) body.size = {e.length, e.width, e.height}, body.centre = e.centre;
    return body;
}

void add_run(RoadWorld& made, const std::filesystem::path& file, const std::filesystem::path& scenario, const RoadNetwork& network) {
    const EsminiRun run = read_esmini_run(file, scenario.empty() ? std::nullopt : std::optional(scenario), &network);
    made.notes.insert(made.notes.end(), run.notes.begin(), run.notes.end());
    for (size_t i = 0; i < run.entities.size(); ++i) {
        const std::string node = "entity_" + std::to_string(i);
        add_plain_body(made.scene, node, body_of(run.entities[i]));
        made.world.world.recordings.push_back(recording_of(run.entities[i], node, network));
    }
}

void add_traffic(RoadWorld& made) {
    const std::vector<Course>& lanes = made.world.world.lanes;
    for (size_t i = 0, lane = 0; i < kTraffic && lane < lanes.size(); ++lane) {
        const double first = lane == made.world.world.driver_lane ? kTrafficGap : 5;
        for (double s = first; s < lanes[lane].length() - 5 && i < kTraffic; s += 2.5 * kTrafficGap, ++i) {
            const std::string node = "car_traffic_" + std::to_string(i);
            add_plain_body(made.scene, node, {});
            made.world.world.cars.push_back({.node = node, .lane = lane, .s = s, .speed = 0.7 * lanes[lane].speed_at(s)});
        }
    }
}

}  // namespace

RoadWorld road_world(const std::filesystem::path& roads, const std::filesystem::path& run, const std::filesystem::path& scenario) {
    const RoadNetwork network = read_opendrive(roads);
    const LaneGraph graph(network);
    LitRoads lit = lit_roads(network);
    RoadWorld made{std::move(lit.scene), {}, std::move(lit.notes)};
    made.world.scene = roads;
    made.world.roles = plain_lamps();
    WorldDescription& world = made.world.world;
    world.lanes = courses_of(graph);
    if (world.lanes.empty()) throw Error(one_line(roads.string()) + ": there is no lane to drive on");
    for (const Kerb& kerb : graph.kerbs()) world.barriers.push_back({{kerb.from.x, kerb.from.z}, {kerb.to.x, kerb.to.z}});
    world.driver_s = 3;
    for (Node& node : made.scene.nodes) {
        // Lamps go by what they are; by day those of the road are off, and signals are not.
        if (node.light != kNone) {
            node.name = made.scene.lights[node.light].name;
            if (node.name != "street lamp" && std::find(made.world.by_day.begin(), made.world.by_day.end(), node.name) == made.world.by_day.end()) made.world.by_day.push_back(node.name);
        }
        if (node.name == "car_ego") world.driver_node = node.name;
        if (node.camera != kNone && made.scene.cameras[node.camera].name == "driver") made.world.camera = "driver";
    }
    if (made.world.by_day.empty()) made.world.by_day = {"none"};
    if (run.empty())
        add_traffic(made);
    else
        add_run(made, run, scenario, network);
    return made;
}

}  // namespace vesper
