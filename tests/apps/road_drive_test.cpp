// Driving on roads of others, among what was recorded on them. SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "places.h"
#include "roads/crossing_text.h"
#include "roads/opendrive.h"
#include "session/road_world.h"
#include "session/scenery.h"
#include "support/complaints.h"
#include "support/driven_along.h"
#include "support/program.h"

namespace vesper::test {
namespace {

const std::string kRoads = std::string(VESPER_SOURCE_DIR) + "/data/rivoli/rivoli.xodr";

// Two entities: one drives towards y, slows down and is gone after 2 s; one stands from 1 s on.
const char* kRun =
    "time, id, name, x, y, z, h, p, r, speed, wheel_angle, wheel_rot\n"
    "0.0, 0, Car, 10.0, 0.0, 0.0, 1.5707963, 0, 0, 10, 0, 0\n"
    "1.0, 0, Car, 10.0, 10.0, 0.0, 1.5707963, 0, 0, 10, 0, 0\n"
    "1.0, 1, Pedestrian, 20.0, 5.0, 0.1, 0, 0, 0, 0, 0, 0\n"
    "2.0, 0, Car, 10.0, 16.0, 0.0, 1.7707963, 0, 0, 2, 0, 0\n"
    "2.0, 1, Pedestrian, 20.0, 5.0, 0.1, 0, 0, 0, 0, 0, 0\n"
    "4.0, 1, Pedestrian, 20.0, 5.0, 0.1, 0, 0, 0, 0, 0, 0\n";

drive::MessageSource run_of(const std::filesystem::path& file) { return {.file = file}; }

TEST(RoadDrive, ARunIsWhereItWasRecorded) {
    const TempFolder folder;
    const roads::RoadNetwork network = roads::read_opendrive(kRoads);
    DrivenAlong run(kRoads, run_of(folder.write("run.csv", kRun)));
    EXPECT_TRUE(run.scenery.world()->cars.empty());
    EXPECT_EQ(run.scenery.world()->external_nodes.size(), 2u);
    drive::ExternalState now = run.at(0.5);
    ASSERT_EQ(now.actors.size(), 1u);
    // The table has the middle of the rear axle, and the middle of the car is 1.32 m ahead.
    EXPECT_LT(glm::distance(now.actors[0].actor.position, network.to_world({10, 5 + 1.32, 0})), 0.01);
    EXPECT_NEAR(std::remainder(now.actors[0].actor.yaw, 2 * std::numbers::pi), 0, 1e-6);  // towards y of the file is -Z
    EXPECT_TRUE(now.actors[0].actor.lamps.low && now.actors[0].actor.lamps.tail);
    EXPECT_FALSE(now.actors[0].actor.lamps.brake);
    EXPECT_LT(run.world.actors()[2].position.y, network.to_world({20, 5, 0}).y - 10) << "not there yet";
    now = run.at(1.5);
    ASSERT_EQ(now.actors.size(), 2u);
    EXPECT_NEAR(now.actors[0].actor.yaw, 0.1, 1e-6);
    EXPECT_LT(glm::distance(now.actors[1].actor.position, network.to_world({20, 5, 0.1})), 0.01);
    EXPECT_TRUE(now.actors[1].person);
    EXPECT_EQ(run.at(4).actors.size(), 1u) << "gone with the message that does not have it";
    EXPECT_FALSE(run.world.actors()[1].lamps.low);
}

TEST(RoadDrive, TheAutopilotFollowsTheRoadAmongTraffic) {
    const drive::RoadWorld made = drive::road_world(kRoads, {}, {});
    EXPECT_FALSE(made.world.world.cars.empty());
    EXPECT_FALSE(made.world.world.barriers.empty());
    traffic::World world(std::make_shared<const traffic::WorldDescription>(made.world.world), 1);
    for (int i = 0; i < 60 * 30; ++i) {
        world.step({.autopilot = true}, 1.0 / 60);
        ASSERT_LT(made.world.world.lanes[world.driver_lane()].beside(world.driver().position).distance, 1) << i;
    }
    EXPECT_GT(world.driver().odometer, 100);
}

TEST(RoadDrive, PlainBodiesHaveTheirLamps) {
    const TempFolder folder;
    const drive::Scenery scenery(kRoads, run_of(folder.write("run.csv", kRun)));
    std::vector<std::string> names;
    for (const drive::LampGroup& group : scenery.lamp_groups()) names.push_back(group.name);
    for (const char* name : {"low beam", "high beam", "tail lamp", "brake lamp", "left front indicator",
                             "right rear indicator", "front fog lamp", "rear fog lamp", "reversing lamp"})
        EXPECT_TRUE(std::find(names.begin(), names.end(), name) != names.end()) << name;
}

// The driver's car has what the one in data/rivoli has: lamps of every kind, the beams as measured, its eye behind the
// bonnet.
TEST(RoadDrive, TheDriversCarHasAllItsLamps) {
    const drive::RoadWorld made = drive::road_world(kRoads, {}, {});
    ASSERT_EQ(made.world.world.driver_node, "car_ego");
    EXPECT_EQ(made.world.camera, "driver");
    const auto& nodes = made.scene.nodes;
    uint32_t car = 0;
    while (nodes[car].name != "car_ego") ++car;
    std::map<std::string, int> lamps;
    for (const scene::Node& node : nodes) {
        if (node.parent != car) continue;
        if (node.camera != scene::kNone) {
            EXPECT_NEAR(node.translation.z, -0.14, 0.01);
        }
        if (node.lamp == scene::kNone) continue;
        const scene::Lamp& light = made.scene.lamps[node.lamp];
        ++lamps[light.name];
        if (light.name.ends_with("beam")) {
            EXPECT_EQ(light.kind, scene::Lamp::Kind::Measured) << light.name;
        }
        const bool rear = light.name.find("rear") != light.name.npos || light.name == "tail lamp" ||
                          light.name == "brake lamp" || light.name == "reversing lamp";
        EXPECT_EQ(node.translation.z > 0, rear) << light.name;
    }
    const std::map<std::string, int> wanted{{"low beam", 2},
                                            {"high beam", 2},
                                            {"tail lamp", 2},
                                            {"brake lamp", 2},
                                            {"front fog lamp", 2},
                                            {"rear fog lamp", 2},
                                            {"reversing lamp", 2},
                                            {"left front indicator", 1},
                                            {"left rear indicator", 1},
                                            {"right front indicator", 1},
                                            {"right rear indicator", 1}};
    EXPECT_EQ(lamps, wanted);
}

// A run on other roads is refused, one that leaves them at times is noted.
TEST(RoadDrive, ARunOfOtherRoadsIsRefused) {
    const TempFolder folder;
    const auto straight = [](double off, double until, double side = 1) {  // 20 places, those before `until` beside it
        std::string rows = "time, id, name, x, y, z, h, p, r, speed, wheel_angle, wheel_rot\n";
        for (int i = 0; i < 20; ++i)
            rows += std::to_string(i * 0.1) + ", 0, Car, " + std::to_string(i < until ? off : 1.5) + ", " +
                    std::to_string(side > 0 ? 10.0 * i : -100.0 - 10 * i) + ", 0, 1.5708, 0, 0, 10, 0, 0\n";
        return rows;
    };
    const auto notes = [&](double off, double until) {
        const std::vector<std::string> all =
            drive::Scenery(kRoads, run_of(folder.write("run.csv", straight(off, until)))).notes();
        return size_t(std::count_if(all.begin(), all.end(),
                                    [](const std::string& note) { return contains(note, "off the roads"); }));
    };
    EXPECT_EQ(notes(1.5, 20), 0u);
    EXPECT_EQ(notes(300, 1), 0u);
    EXPECT_EQ(notes(300, 3), 1u);
    const std::string complaint = complaint_of([&] { notes(300, 12); });
    EXPECT_TRUE(contains(complaint, "run.csv: 60 % of the places of its vehicles lie more than 3 m off the roads of "))
        << complaint;
    EXPECT_TRUE(contains(complaint, "rivoli.xodr")) << complaint;
    EXPECT_FALSE(contains(complaint, "the sign of y")) << complaint;
    const std::string mirrored =
        complaint_of([&] { drive::Scenery(kRoads, run_of(folder.write("run.csv", straight(1.5, 20, -1)))); });
    EXPECT_TRUE(contains(mirrored, "with the sign of y turned round they lie on them")) << mirrored;
}

/// Red, yellow and green lenses that shine.
std::vector<int> lit_signals(const drive::Scenery& scenery, const gpu_scene::SceneFrame& frame) {
    std::map<std::string, int> count;
    for (size_t i = 0; i < scenery.scene().nodes.size(); ++i) {
        const scene::Node& node = scenery.scene().nodes[i];
        if (node.lamp != scene::kNone && frame.dimming[i] > 0) ++count[scenery.scene().lamps[node.lamp].name];
    }
    return {count["red signal"], count["yellow signal"], count["green signal"]};
}

// Lenses are found by signal and colour, or by their places; they shine as messages say, and otherwise as cars wait.
TEST(RoadDrive, MessagesSwitchTrafficLights) {
    const std::filesystem::path roads =
        std::filesystem::path(VESPER_SHARED_DATA) / "scenario/esmini/xodr/fabriksgatan_traffic_lights.xodr";
    if (!std::filesystem::exists(roads)) GTEST_SKIP() << "no shared data";
    const drive::Scenery scenery(roads, {.live = true});
    const traffic::World world(scenery.world(), 1);
    drive::ExternalPlaces places = scenery.external_places();
    const auto lit = [&](const osi::Moment& moment) {
        return lit_signals(scenery, scenery.frame(world.actors(), drive::DriveSettings(), places.place(moment)));
    };
    EXPECT_EQ(lit({}), (std::vector<int>{1, 0, 2})) << "cars wait, people walk";
    using Colour = osi::TrafficLight::Colour;
    const auto light = [](uint64_t id, Colour colour, osi::LampState state) {
        return osi::TrafficLightNow{{.id = id, .signal = "1", .colour = colour, .state = state}};
    };
    osi::Moment moment;
    moment.traffic_lights = {light(1, Colour::Red, osi::LampState::Off), light(2, Colour::Yellow, osi::LampState::On),
                             light(3, Colour::Green, osi::LampState::Off)};
    EXPECT_EQ(lit(moment), (std::vector<int>{0, 1, 2}));
    // By their places, half a metre away.
    for (const drive::SignalLens& lens : scenery.lenses())
        if (lens.signal != "1")
            moment.traffic_lights.push_back(
                {{.id = 10 + lens.node,
                  .position = scenery.message_frame().back(lens.position) + glm::dvec3(0.3, 0.4, 0),
                  .colour = lens.colour,
                  .state = lens.colour == Colour::Red ? osi::LampState::On : osi::LampState::Off}});
    EXPECT_EQ(lit(moment), (std::vector<int>{2, 1, 0}));
    moment.traffic_lights[1] = light(2, Colour::Yellow, osi::LampState::Flashing);
    EXPECT_EQ(lit(moment), (std::vector<int>{2, 1, 0}));
    moment.traffic_lights[1].state_for = 0.6;
    EXPECT_EQ(lit(moment), (std::vector<int>{2, 0, 0}));
    // A signal of which one lens is spoken of, or one that changes its colour, shows no other.
    moment.traffic_lights = {light(1, Colour::Red, osi::LampState::On)};
    EXPECT_EQ(lit(moment), (std::vector<int>{1, 0, 2}));
    moment.traffic_lights = {light(1, Colour::Green, osi::LampState::On)};
    EXPECT_EQ(lit(moment), (std::vector<int>{0, 0, 3}));
}

// Nobody says: the plan of the roads runs with the drive.
TEST(RoadDrive, TrafficLightsChangeByThemselves) {
    const std::filesystem::path roads =
        std::filesystem::path(VESPER_SHARED_DATA) / "scenario/esmini/xodr/fabriksgatan_traffic_lights.xodr";
    if (!std::filesystem::exists(roads)) GTEST_SKIP() << "no shared data";
    const drive::Scenery scenery(roads);
    const traffic::World world(scenery.world(), 1);
    const auto lit = [&](double seconds) {
        drive::ExternalState nobody;
        nobody.seconds = seconds;
        return lit_signals(scenery, scenery.frame(world.actors(), drive::DriveSettings(), nobody));
    };
    // 12 s of green for people on foot in 25 s, then 20 s of green and 3 s of amber for cars.
    EXPECT_EQ(lit(1), (std::vector<int>{1, 0, 2}));
    EXPECT_EQ(lit(13), (std::vector<int>{3, 0, 0}));
    EXPECT_EQ(lit(26), (std::vector<int>{2, 0, 1}));
    EXPECT_EQ(lit(46), (std::vector<int>{2, 1, 0}));
    EXPECT_EQ(lit(49), (std::vector<int>{3, 0, 0}));
    EXPECT_EQ(lit(51), (std::vector<int>{1, 0, 2}));
}

// A record that does not speak of lights: one lens a head, as the plan has it at the beginning.
TEST(RoadDrive, TrafficLightsOfARecordWithoutThemStay) {
    const TempFolder folder;
    std::string rows = "time, id, name, x, y, z, h, p, r, speed, wheel_angle, wheel_rot\n";
    for (int i = 0; i < 20; ++i)
        rows += std::to_string(i * 2) + ", 0, Car, " + std::to_string(-60 + i) + ", -1.75, 0, 0, 0, 0, 1, 0, 0\n";
    const drive::Scenery scenery(folder.write("roads.xodr", opendrive(crossing_text(false))),
                                 run_of(folder.write("run.csv", rows)));
    const traffic::World world(scenery.world(), 1);
    for (const double seconds : {0.0, 30.0}) {
        drive::ExternalState nobody;
        nobody.seconds = seconds;
        const std::vector<int> lit =
            lit_signals(scenery, scenery.frame(world.actors(), drive::DriveSettings(), nobody));
        EXPECT_EQ(lit[0], 4) << seconds;
        EXPECT_EQ(lit[2], 4) << seconds;
    }
}

class RoadDriveProgram : public ProgramTest {
protected:
    RoadDriveProgram() : ProgramTest(VESPER_DRIVE) {}
};

TEST_F(RoadDriveProgram, ReplaysARunToTheBit) {
    folder.write("run.csv", kRun);
    const std::string common = "--headless --size 64x40 --indirect off ";
    ASSERT_EQ(
        run(common + kRoads + " --scenario run.csv --autopilot --seconds 0.5 --fps 10 --record d.json --video a%d.png"),
        0)
        << said;
    ASSERT_EQ(run(common + "--replay d.json --video b%d.png"), 0) << said;
    for (int i = 0; i < 6; ++i)
        EXPECT_EQ(read_text(folder / ("a" + std::to_string(i) + ".png")),
                  read_text(folder / ("b" + std::to_string(i) + ".png")))
            << i;
    expect_refused(common + kRoads + " --scenario no.csv --video a%d.png", {"no.csv"});
    expect_refused(common + kRoads + " --models m.json --video a%d.png", {"--models", "--osi"});
}

}  // namespace
}  // namespace vesper::test
