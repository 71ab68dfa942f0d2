#include "road_world.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include "base/error.h"
#include "base/one_line.h"
#include "io/in_file.h"
#include "plain_car.h"
#include "roads/esmini_run.h"
#include "roads/lit_roads.h"
#include "roads/opendrive.h"

namespace vesper::drive {
namespace {

constexpr size_t kMostCourses = 64, kTraffic = 8;
constexpr double kTrafficGap = 60;  // m
constexpr double kOffRoad = 3;      // m beyond the edge of the nearest lane
// Parts of a run that may lie there: some leave the road on purpose; where most do, it is another road.
constexpr double kMostOffNoted = 0.05, kMostOff = 0.5;

// A way over lanes as one line.
std::optional<traffic::Course> course_of(const roads::LaneGraph& graph, const std::vector<uint32_t>& way) {
    std::vector<glm::dvec3> points;
    std::vector<double> limits;  // m/s from each point on
    const double width = std::max(graph.lanes()[way.front()].poses.front().width, 2.0);
    for (const uint32_t index : way) {
        const roads::Lane& lane = graph.lanes()[index];
        for (const roads::LanePose& pose : lane.poses) {
            const double limit = roads::allowed_speed(lane, pose, limits.empty() ? 0 : limits.back());
            if (points.empty() ||
                std::hypot(pose.position.x - points.back().x, pose.position.z - points.back().z) > 0.2)
                points.push_back(pose.position), limits.push_back(limit);
            else
                limits.back() = limit;  // where one lane ends and the next begins
        }
    }
    if (points.size() < 2) return std::nullopt;
    const auto& next = graph.lanes()[way.back()].successors;
    const bool closed = std::find(next.begin(), next.end(), way.front()) != next.end();
    if (closed && std::hypot(points.front().x - points.back().x, points.front().z - points.back().z) < 0.2)
        points.pop_back(), limits.pop_back();
    return traffic::Course(graph.lanes()[way.front()].name, std::move(points), width, limits, closed);
}

// Ways from every lane that none leads to, and from the first of what these leave out; the longest first.
std::vector<traffic::Course> courses_of(const roads::LaneGraph& graph) {
    std::vector<bool> passed(graph.lanes().size(), false);
    std::vector<traffic::Course> courses;
    const auto take = [&](uint32_t from) {
        const std::vector<uint32_t> way = graph.long_route(from);
        for (const uint32_t lane : way) passed[lane] = true;
        if (const auto course = way.empty() ? std::nullopt : course_of(graph, way)) courses.push_back(*course);
    };
    const auto take_all = [&](const auto& wanted) {
        for (const bool entries : {true, false})
            for (uint32_t i = 0; i < graph.lanes().size() && courses.size() < kMostCourses; ++i) {
                const roads::Lane& lane = graph.lanes()[i];
                if (wanted(lane.type) && !passed[i] && (!entries || lane.predecessors.empty())) take(i);
            }
    };
    take_all([](roads::LaneType type) { return type == roads::LaneType::Driving; });
    if (courses.empty()) take_all(roads::is_driven);  // ramps alone
    std::stable_sort(courses.begin(), courses.end(),
                     [](const traffic::Course& a, const traffic::Course& b) { return a.length() > b.length(); });
    return courses;
}

traffic::VehicleLamps lamps_at(const roads::RunEntity& e, double time) {
    const auto lit = [&](roads::RunLamp lamp) { return roads::lamp_at(e, lamp, time).level > 0.5; };
    const bool low = lit(roads::RunLamp::LowBeam), high = lit(roads::RunLamp::HighBeam);
    return {.low = low,
            .high = high,
            .tail = low || high || lit(roads::RunLamp::FogRear),
            .brake = lit(roads::RunLamp::Brake),
            .left = lit(roads::RunLamp::IndicatorLeft),
            .right = lit(roads::RunLamp::IndicatorRight)};
}

PlainBody body_of(const roads::RunEntity& e) {
    using Kind = roads::RunEntity::Kind;
    const bool vehicle =
        e.kind == Kind::Car || e.kind == Kind::Truck || e.kind == Kind::Bus || e.kind == Kind::Motorcycle;
    const glm::dvec3 usual = e.kind == Kind::Truck || e.kind == Kind::Bus ? glm::dvec3(10, 2.5, 3)
                             : vehicle                                    ? glm::dvec3(4.4, 1.8, 1.5)
                                                                          : glm::dvec3(0.5, 0.6, 1.75);
    PlainBody body{.size = usual, .centre = {vehicle ? usual.x * 0.3 : 0, 0, usual.z / 2}, .lamps = vehicle};
    if (e.length > 0 && e.width > 0 && e.height > 0) body.size = {e.length, e.width, e.height}, body.centre = e.centre;
    return body;
}

traffic::RecordedMover recording_of(const roads::RunEntity& e, const std::string& node,
                                    const roads::RoadNetwork& network) {
    using Kind = roads::RunEntity::Kind;
    const PlainBody body = body_of(e);
    traffic::RecordedMover r{.node = node,
                             .length = body.size.x,
                             .width = body.size.y,
                             .middle = body.centre.x,
                             .person = e.kind == Kind::Pedestrian || e.kind == Kind::Animal,
                             .poses = {}};
    for (const roads::RunPose& p : e.poses)
        r.poses.push_back({p.time, network.to_world(p.position), p.heading - std::numbers::pi / 2, -p.pitch, p.roll,
                           p.speed, lamps_at(e, p.time)});
    return r;
}

std::string add_body(scene::Scene& scene, const std::string& name, const PlainBody& body) {
    scene.nodes.push_back({.name = name});
    add_plain_body(scene, uint32_t(scene.nodes.size() - 1), body);
    return name;
}

// The driver's car of the road's scene stands on the middle of its front axle, that of a world on its own middle.
void add_drivers_car(RoadWorld& made, const traffic::VehicleParameters& vehicle) {
    scene::Scene& scene = made.scene;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].name != "car_ego") continue;
        made.world.world.driver_node = scene.nodes[i].name;
        for (scene::Node& node : scene.nodes) {
            if (node.parent != i) continue;
            node.translation.z -= float((vehicle.front_axle + vehicle.rear_axle) / 2);
            if (node.camera != scene::kNone && scene.cameras[node.camera].name == "driver")
                made.world.camera = "driver";
        }
        return add_plain_body(scene, i,
                              {.size = {vehicle.length, vehicle.width, 1.5},
                               .reflectance = glm::vec3(0.04f)});  // a dark bonnet; from within, faces look away
    }
}

// Whether the run was made on these roads: part of the places of its vehicles that lie off all lanes.
double share_off(const roads::EsminiRun& run, const roads::RoadNetwork& network, const roads::LaneGraph& graph) {
    constexpr size_t kLooks = 500;  // of an entity
    size_t all = 0, off = 0;
    for (const roads::RunEntity& e : run.entities) {
        if (e.kind == roads::RunEntity::Kind::Pedestrian || e.kind == roads::RunEntity::Kind::Animal ||
            e.kind == roads::RunEntity::Kind::Object)
            continue;
        for (size_t i = 0; i < e.poses.size(); i += 1 + e.poses.size() / kLooks, ++all) {
            const auto lane =
                graph.nearest(network.to_world(e.poses[i].position), 20, [](const roads::Lane&) { return true; });
            off += !lane || lane->distance - graph.pose(*lane).width / 2 > kOffRoad;
        }
    }
    return all > 0 ? double(off) / double(all) : 0;
}

void check_place(RoadWorld& made, const roads::EsminiRun& run, const std::filesystem::path& file,
                 const roads::RoadNetwork& network, const roads::LaneGraph& graph) {
    const double share = share_off(run, network, graph);
    if (share <= kMostOffNoted) return;
    char text[160];
    std::snprintf(text, sizeof text, ": %.0f %% of the places of its vehicles lie more than %.0f m off the roads of ",
                  100 * share, kOffRoad);
    const std::string complaint = one_line(file.string()) + text + one_line(made.world.scene.string()) +
                                  (run.road_file.empty() ? "" : "; its scenario names " + one_line(run.road_file));
    if (share > kMostOff) throw Error(complaint);
    made.notes.push_back(complaint);
}

void add_run(RoadWorld& made, const roads::EsminiRun& run, const roads::RoadNetwork& network) {
    made.notes.insert(made.notes.end(), run.notes.begin(), run.notes.end());
    for (size_t i = 0; i < run.entities.size(); ++i) {
        const std::string node = add_body(made.scene, "entity_" + std::to_string(i), body_of(run.entities[i]));
        made.world.world.recordings.push_back(recording_of(run.entities[i], node, network));
    }
}

void add_traffic(RoadWorld& made) {
    const std::vector<traffic::Course>& lanes = made.world.world.lanes;
    for (size_t i = 0, lane = 0; i < kTraffic && lane < lanes.size(); ++lane) {
        const double first = lane == made.world.world.driver_lane ? kTrafficGap : 5;
        for (double s = first; s < lanes[lane].length() - 5 && i < kTraffic; s += 2.5 * kTrafficGap, ++i) {
            const std::string node = add_body(made.scene, "car_traffic_" + std::to_string(i), {});
            made.world.world.cars.push_back(
                {.node = node, .lane = lane, .s = s, .speed = 0.7 * lanes[lane].speed_at(s)});
        }
    }
}

}  // namespace

RoadWorld road_world(const std::filesystem::path& roads, const std::filesystem::path& run,
                     const std::filesystem::path& scenario) {
    const roads::RoadNetwork network = roads::read_opendrive(roads);
    const roads::LaneGraph graph(network);
    std::optional<roads::EsminiRun> recorded;
    if (!run.empty())
        recorded = roads::read_esmini_run(run, scenario.empty() ? std::nullopt : std::optional(scenario), &network);
    const bool switched = recorded && !recorded->signals.empty();
    roads::LitRoads lit = io::in_file(
        roads.string(), [&] { return roads::lit_roads(network, {.headlamps = false, .every_lens = switched}); });
    RoadWorld made{.scene = std::move(lit.scene), .world = {}, .lenses = {}, .notes = std::move(lit.notes)};
    made.world.scene = roads;
    made.world.roles = plain_lamps();
    traffic::WorldDescription& world = made.world.world;
    world.lanes = courses_of(graph);
    if (world.lanes.empty()) throw Error(one_line(roads.string()) + ": there is no lane to drive on");
    // Where nothing rises there is nothing to hit: edges without a kerb also lie across junctions, between one road's
    // lanes and another's.
    for (const roads::Kerb& kerb : graph.kerbs())
        if (kerb.height > 0)
            world.barriers.push_back({.line = {{kerb.from.x, kerb.from.z}, {kerb.to.x, kerb.to.z}},
                                      .height = (kerb.from.y + kerb.to.y) / 2});
    world.driver_s = 3;
    if (recorded) check_place(made, *recorded, run, network, graph);
    if (switched) made.lenses = lenses_of(made.scene, network, *recorded, made.notes);
    for (scene::Node& node : made.scene.nodes) {
        // Lamps go by what they are; by day those of the road are off, and signals are not.
        if (node.lamp != scene::kNone) {
            node.name = made.scene.lamps[node.lamp].name;
            if (node.name != "street lamp" &&
                std::find(made.world.by_day.begin(), made.world.by_day.end(), node.name) == made.world.by_day.end())
                made.world.by_day.push_back(node.name);
        }
    }
    add_drivers_car(made, world.vehicle);
    if (made.world.by_day.empty()) made.world.by_day = {"none"};
    if (recorded)
        add_run(made, *recorded, network);
    else
        add_traffic(made);
    return made;
}

}  // namespace vesper::drive
