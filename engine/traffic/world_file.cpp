#include "traffic/world_file.h"

#include <algorithm>
#include <numbers>

#include "base/decimal.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/read_file.h"
#include "scene/json_value.h"
#include "scene/uri.h"

namespace vesper::traffic {
namespace {

using scene::JsonValue;

constexpr uint64_t kMostBytes = 64u << 20;
constexpr double kFar = 1e6;  // m
// With more, steps would take longer than a drive has patience for.
constexpr size_t kMostPoints = 100'000, kMostMovers = 1000;
constexpr double kLongestPaths = 10'000;  // m, of all walkers' paths

glm::dvec3 point_of(const JsonValue& value) {
    const auto xyz = value.elements(3);
    return {xyz[0].number(-kFar, kFar), xyz[1].number(-kFar, kFar), xyz[2].number(-kFar, kFar)};
}

Course lane_of(const JsonValue& value, double width, double speed) {
    value.allow_only({"name", "points", "width_m", "speed_km_h", "closed", "left", "right"});
    std::vector<glm::dvec3> points;
    for (const JsonValue& point : value.at("points").elements()) points.push_back(point_of(point));
    try {
        return {value.at("name").text(), std::move(points), value.number_or("width_m", width, 0.5, 20),
                value.number_or("speed_km_h", speed, 0.1, 300) / 3.6, value.boolean_or("closed", false)};
    } catch (const Error& error) {
        value.fail(error.what());
    }
}

std::vector<Course> lanes_of(const JsonValue& root, const char* key, double width, double speed) {
    std::vector<Course> lanes;
    size_t points = 0;
    for (const JsonValue& value : root.elements_of(key)) {
        lanes.push_back(lane_of(value, width, speed));
        points += value.at("points").elements().size();
        if (points > kMostPoints)
            value.fail("with this one there are more than " + std::to_string(kMostPoints) + " points");
    }
    return lanes;
}

size_t index_of(const JsonValue& name, const std::vector<Course>& lanes) {
    for (size_t i = 0; i < lanes.size(); ++i)
        if (lanes[i].name() == name.text()) return i;
    name.fail("there is no lane " + one_line(name.text()));
}

std::vector<std::string> names_of(const JsonValue& root, const char* key) {
    std::vector<std::string> names;
    for (const JsonValue& name : root.elements_of(key)) names.push_back(name.text());
    return names;
}

Beam beam_of(const JsonValue& car) {
    const std::string beam = car.text_or("beam", "low");
    if (beam == "low") return Beam::Low;
    if (beam == "high") return Beam::High;
    if (beam == "off") return Beam::Off;
    car.at("beam").fail("is none of off, low and high");
}

// The turn of a mover's node.
void read_turn(const JsonValue& mover, WorldFile& file) {
    const auto front = mover.find("front");
    if (!front) return;
    const std::string node = mover.text_or("node", "");
    if (node.empty()) front->fail("of which node? there is none");
    file.turns[node] = read_front(mover);
}

void read_cars(const JsonValue& root, WorldFile& file) {
    WorldDescription& world = file.world;
    for (const char* movers : {"cars", "walkers"})
        if (root.elements_of(movers).size() > kMostMovers)
            root.at(movers).fail("more than " + std::to_string(kMostMovers));
    for (const JsonValue& car : root.elements_of("cars")) {
        car.allow_only({"node", "front", "lane", "at_m", "speed_km_h", "length_m", "width_m", "beam", "wish"});
        world.cars.push_back({.node = car.at("node").text(),
                              .lane = index_of(car.at("lane"), world.lanes),
                              .s = car.number_or("at_m", 0, -kFar, kFar),
                              .speed = car.number_or("speed_km_h", 0, 0, 300) / 3.6,
                              .length = car.number_or("length_m", 4.4, 0.5, 50),
                              .width = car.number_or("width_m", 1.8, 0.3, 10),
                              .speed_factor = car.number_or("wish", 0, 0.05, 2),
                              .beam = beam_of(car)});
        read_turn(car, file);
    }
    for (const JsonValue& walker : root.elements_of("walkers")) {
        walker.allow_only({"node", "front", "path", "wait_s", "at_m"});
        world.walkers.push_back({walker.at("node").text(), index_of(walker.at("path"), world.paths),
                                 walker.number_or("wait_s", 5, 0, 1e6), walker.number_or("at_m", 0, 0, kFar)});
        read_turn(walker, file);
    }
}

void read_driver(const JsonValue& driver, WorldFile& file) {
    driver.allow_only({"node", "front", "camera", "lane", "at_m", "speed_km_h"});
    file.camera = driver.text_or("camera", "");
    file.world.driver_node = driver.text_or("node", "");
    read_turn(driver, file);
    file.world.driver_lane = index_of(driver.at("lane"), file.world.lanes);
    file.world.driver_s = driver.number_or("at_m", 0, -kFar, kFar);
    const Course& lane = file.world.lanes[file.world.driver_lane];
    if (!lane.closed() && !(file.world.driver_s >= 0 && file.world.driver_s <= lane.length()))
        driver.at("at_m").fail("is not on the lane, which is " + decimal(lane.length(), 9) + " m long");
    file.world.driver_speed = driver.number_or("speed_km_h", 0, 0, 300) / 3.6;
}

}  // namespace

double read_front(const JsonValue& model) {
    const auto front = model.find("front");
    if (!front) return 0;
    constexpr double kQuarter = std::numbers::pi / 2;
    const std::map<std::string, double> turns{{"-z", 0}, {"+x", kQuarter}, {"+z", 2 * kQuarter}, {"-x", -kQuarter}};
    const auto turn = turns.find(front->text());
    if (turn == turns.end()) front->fail("is none of -z, +z, -x and +x");
    return turn->second;
}

LampRoles read_roles(const JsonValue& lamps) {
    lamps.allow_only({"low", "high", "tail", "brake", "left", "right", "front_fog", "rear_fog", "reversing"});
    LampRoles roles;
    for (const auto& [role, names] : kLampRoles) roles.*names = names_of(lamps, role);
    return roles;
}

WorldFile read_world(const std::filesystem::path& path) {
    const scene::JsonFile json = scene::parse_json(io::read_file(path, kMostBytes), path.string());
    const JsonValue root(json);
    root.allow_only({"$schema", "version", "scene", "photometry", "driver", "lanes", "paths", "barriers", "cars",
                     "walkers", "lamps", "lit_by_day", "tunnels"});
    if (root.at("version").integer() != 1) root.at("version").fail("this version of Vesper reads worlds of version 1");
    WorldFile file;
    const auto beside = [&](const JsonValue& name) {
        try {
            return scene::resolve_uri(path.parent_path(), name.text());
        } catch (const Error& error) {
            name.fail(error.what());
        }
    };
    file.scene = beside(root.at("scene"));
    if (const auto photometry = root.find("photometry")) file.photometry = beside(*photometry);

    file.world.lanes = lanes_of(root, "lanes", 3.5, 50);
    if (file.world.lanes.empty()) root.fail("a world needs a lane");
    const auto lanes = root.at("lanes").elements();
    for (size_t i = 0; i < lanes.size(); ++i) {
        if (const auto left = lanes[i].find("left")) file.world.lanes[i].left = int(index_of(*left, file.world.lanes));
        if (const auto right = lanes[i].find("right"))
            file.world.lanes[i].right = int(index_of(*right, file.world.lanes));
    }
    file.world.paths = lanes_of(root, "paths", 1, 4.7);  // km/h: 1.3 m/s
    double walked = 0;
    for (const Course& walk : file.world.paths) walked += walk.length();
    if (walked > kLongestPaths)
        root.at("paths").fail("are longer than " + std::to_string(int(kLongestPaths)) + " m in all");
    size_t points = 0;
    for (const JsonValue& barrier : root.elements_of("barriers")) {
        points += barrier.elements().size();
        if (points > kMostPoints)
            barrier.fail("with this one there are more than " + std::to_string(kMostPoints) + " points");
        file.world.barriers.emplace_back();
        for (const JsonValue& point : barrier.elements()) {
            const auto xz = point.elements(2);
            file.world.barriers.back().line.emplace_back(xz[0].number(-kFar, kFar), xz[1].number(-kFar, kFar));
        }
    }
    read_cars(root, file);
    read_driver(root.at("driver"), file);
    if (const auto lamps = root.find("lamps")) {
        file.roles = read_roles(*lamps);
    }
    file.by_day = names_of(root, "lit_by_day");
    for (const JsonValue& tunnel : root.elements_of("tunnels")) {
        tunnel.allow_only({"from", "to", "width_m", "height_m"});
        file.tunnels.push_back({glm::vec3(point_of(tunnel.at("from"))), glm::vec3(point_of(tunnel.at("to"))),
                                float(tunnel.at("width_m").number(0.5, 100)),
                                float(tunnel.at("height_m").number(0.5, 100))});
        if (glm::distance(file.tunnels.back().from, file.tunnels.back().to) < 0.1)
            tunnel.fail("must be longer than 0.1 m");
    }
    return file;
}

}  // namespace vesper::traffic
