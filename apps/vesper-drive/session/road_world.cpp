#include "session/road_world.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/one_line.h"
#include "external/external_places.h"
#include "external/plain_car.h"
#include "io/in_file.h"
#include "print.h"
#include "roads/lit_roads.h"
#include "roads/opendrive.h"
#include "roads/road_surface.h"

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

std::string add_body(scene::Scene& scene, const std::string& name, const PlainBody& body) {
    scene.nodes.push_back({.name = name});
    add_plain_body(scene, uint32_t(scene.nodes.size() - 1), "plain car", body);
    return name;
}

// Where a road has objects and signals, on its surface.
std::vector<glm::dvec3> things_of(const roads::RoadNetwork& network) {
    constexpr size_t kMost = 20'000;
    std::vector<glm::dvec3> made;
    for (const roads::Road& road : network.roads) {
        const auto add = [&](double s, double t) {
            if (made.size() < kMost) made.push_back(network.to_world(roads::surface_point(road, s, t).position));
        };
        for (const roads::RoadSignal& signal : road.signals) add(signal.s, signal.t);
        for (const roads::RoadObject& object : road.objects) {
            add(object.s, object.t);
            for (const roads::ObjectRepeat& repeat : object.repeats)
                for (double at = 0; repeat.distance > 0.1 && at <= repeat.length && made.size() < kMost;
                     at += repeat.distance)
                    add(repeat.s + at, glm::mix(repeat.t_start, repeat.t_end, at / std::max(repeat.length, 1e-9)));
        }
    }
    return made;
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
        return add_plain_body(scene, i, scene.nodes[i].name,
                              {.size = {vehicle.length, vehicle.width, 1.5},
                               .reflectance = glm::vec3(0.04f)});  // a dark bonnet; from within, faces look away
    }
}

// Whether messages are of these roads: part of the places of their vehicles that lie off all lanes. `side`: -1 turns y
// round.
double share_off(std::span<const osi::Message> messages, const MessageFrame& frame, const roads::LaneGraph& graph,
                 double side) {
    constexpr size_t kLooks = 5000;
    size_t objects = 0;
    for (const osi::Message& message : messages) objects += message.objects.size();
    size_t number = 0, all = 0, off = 0;
    for (const osi::Message& message : messages)
        for (const osi::MovingObject& object : message.objects) {
            if (number++ % (1 + objects / kLooks) > 0 || object.kind >= osi::MovingObject::Kind::Pedestrian) continue;
            const auto lane = graph.nearest(frame.point(object.centre * glm::dvec3(1, side, 1)), 20,
                                            [](const roads::Lane&) { return true; });
            ++all;
            off += !lane || lane->distance - graph.pose(*lane).width / 2 > kOffRoad;
        }
    return all > 0 ? double(off) / double(all) : 0;
}

void check_place(RoadWorld& made, const MessageSource& source, std::span<const osi::Message> messages,
                 const roads::LaneGraph& graph) {
    const MessageFrame frame = frame_of(source, made.origin);
    const double share = share_off(messages, frame, graph, 1);
    if (share <= kMostOffNoted) return;
    std::string complaint =
        one_line(source.file.string()) +
        apps::format(": %.0f %% of the places of its vehicles lie more than %.0f m off the roads of ", 100 * share,
                     kOffRoad) +
        one_line(made.world.scene.string());
    if (share_off(messages, frame, graph, -1) <= kMostOffNoted)
        complaint += "; with the sign of y turned round they lie on them: y of OSI is to the left of x";
    if (share > kMostOff && !source.live) throw Error(complaint);  // what was driven can be driven again
    made.notes.push_back(complaint);
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

RoadWorld road_world(const std::filesystem::path& roads, const MessageSource& source,
                     std::span<const osi::Message> messages) {
    const roads::RoadNetwork network = roads::read_opendrive(roads);
    const roads::LaneGraph graph(network);
    // Messages that do not speak of lights leave them as they are; in a drive of its own the plan runs.
    const bool every_lens = !source.any() || source.live ||
                            std::any_of(messages.begin(), messages.end(),
                                        [](const osi::Message& message) { return !message.traffic_lights.empty(); });
    roads::LitRoads lit = io::in_file(
        roads.string(), [&] { return roads::lit_roads(network, {.headlamps = false, .every_lens = every_lens}); });
    if (!every_lens) lit.phases.clear();
    RoadWorld made{.scene = std::move(lit.scene),
                   .world = {},
                   .bodies = {},
                   .lenses = {},
                   .origin = network.origin,
                   .things = {},
                   .notes = std::move(lit.notes)};
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
    made.things = things_of(network);
    check_place(made, source, messages, graph);
    made.lenses = lenses_of(made.scene, lit.phases);
    if (!every_lens)
        for (SignalLens& lens : made.lenses) lens.otherwise = true;  // one lens a head was built, by the plan
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
    if (source.any())
        made.bodies = ExternalBodies(made.scene, made.world, source, messages);
    else
        add_traffic(made);
    return made;
}

}  // namespace vesper::drive
