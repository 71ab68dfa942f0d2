// Driving on roads of others, among what was recorded on them. SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "places.h"
#include "road_world.h"
#include "roads/opendrive.h"
#include "scenery.h"
#include "support/complaints.h"
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

TEST(RoadDrive, ARunIsWhereItWasRecorded) {
    const TempFolder folder;
    const roads::RoadNetwork network = roads::read_opendrive(kRoads);
    const drive::RoadWorld made = drive::road_world(kRoads, folder.write("run.csv", kRun), {});
    ASSERT_EQ(made.world.world.recordings.size(), 2u);
    EXPECT_TRUE(made.world.world.cars.empty());
    traffic::World world(std::make_shared<const traffic::WorldDescription>(made.world.world), 1);
    const auto entity = [&](size_t i) { return world.actors()[1 + i]; };
    const auto until = [&](double t) {
        while (world.seconds() < t - 1e-9) world.step({}, 0.125);
    };
    until(0.5);
    EXPECT_LT(glm::distance(entity(0).position, network.to_world({10, 5, 0})), 0.01);
    EXPECT_NEAR(std::remainder(entity(0).yaw, 2 * std::numbers::pi), 0, 1e-6);  // towards y of the file is -Z
    EXPECT_TRUE(entity(0).lamps.low && entity(0).lamps.tail);
    EXPECT_FALSE(entity(0).lamps.brake);
    EXPECT_LT(entity(1).position.y, network.to_world({20, 5, 0}).y - 10) << "not there yet";
    until(1.5);
    EXPECT_LT(glm::distance(entity(0).position, network.to_world({10, 13, 0})), 0.01);
    EXPECT_NEAR(entity(0).yaw, 0.1, 1e-6);
    EXPECT_LT(glm::distance(entity(1).position, network.to_world({20, 5, 0.1})), 0.01);
    until(3);
    EXPECT_LT(entity(0).position.y, network.to_world({10, 16, 0}).y - 10) << "gone";
    EXPECT_FALSE(entity(0).lamps.low);
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
    const drive::Scenery scenery(kRoads, folder.write("run.csv", kRun));
    std::vector<std::string> names;
    for (const drive::LampGroup& group : scenery.lamp_groups()) names.push_back(group.name);
    for (const char* name :
         {"low beam", "high beam", "tail lamp", "brake lamp", "left front indicator", "right rear indicator"})
        EXPECT_TRUE(std::find(names.begin(), names.end(), name) != names.end()) << name;
    EXPECT_THROW(drive::Scenery(std::string(VESPER_SOURCE_DIR) + "/data/rivoli/rivoli.world.json", folder / "run.csv"),
                 Error);
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
        const bool rear =
            light.name.find("rear") != light.name.npos || light.name == "tail lamp" || light.name == "brake lamp";
        EXPECT_EQ(node.translation.z > 0, rear) << light.name;
    }
    const std::map<std::string, int> wanted{{"low beam", 2},
                                            {"high beam", 2},
                                            {"tail lamp", 2},
                                            {"brake lamp", 2},
                                            {"left front indicator", 1},
                                            {"left rear indicator", 1},
                                            {"right front indicator", 1},
                                            {"right rear indicator", 1}};
    EXPECT_EQ(lamps, wanted);
}

// A run on other roads is refused, one that leaves them at times is noted.
TEST(RoadDrive, ARunOfOtherRoadsIsRefused) {
    const TempFolder folder;
    const auto straight = [](double off, double until) {  // 20 places, those before `until` beside the road
        std::string rows = "time, id, name, x, y, z, h, p, r, speed, wheel_angle, wheel_rot\n";
        for (int i = 0; i < 20; ++i)
            rows += std::to_string(i * 0.1) + ", 0, Car, " + std::to_string(i < until ? off : 1.5) + ", " +
                    std::to_string(10.0 * i) + ", 0, 1.5708, 0, 0, 10, 0, 0\n";
        return rows;
    };
    const auto notes = [&](double off, double until) {
        const std::vector<std::string> all =
            drive::road_world(kRoads, folder.write("run.csv", straight(off, until)), {}).notes;
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
}

TEST(RoadDrive, StatesOfTrafficLights) {
    using Mode = drive::SignalLens::Mode;
    constexpr Mode O = Mode::Off, I = Mode::On, F = Mode::Flashing;
    const std::vector<std::pair<const char*, std::vector<Mode>>> known{{"off;off;on", {O, O, I}},
                                                                       {"off; flashing ;on", {O, F, I}},
                                                                       {"ON;Off;OFF", {I, O, O}},
                                                                       {"red", {I, O, O}},
                                                                       {"Red", {I, O, O}},
                                                                       {"stop", {I, O, O}},
                                                                       {"GREEN", {O, O, I}},
                                                                       {"amber", {O, I, O}},
                                                                       {"redyellow", {I, I, O}},
                                                                       {"red-yellow", {I, I, O}},
                                                                       {"RED_AMBER", {I, I, O}},
                                                                       {"yellow flashing", {O, F, O}},
                                                                       {"Flashing Yellow", {O, F, O}},
                                                                       {"blinking,red", {F, O, O}},
                                                                       {"green on", {O, O, I}},
                                                                       {"off", {O, O, O}},
                                                                       {"OFF", {O, O, O}}};
    for (const auto& [state, shown] : known)
        EXPECT_EQ(drive::lenses_in(state, {"red", "yellow", "green"}), shown) << state;
    // Words that are none, or say nothing of these lenses, among them what once looked like a colour.
    for (const char* state :
         {"", " ", ";", "on", "flashing", "on;off", "on;off;off;off", "red;off;off", "red;yellow", "red off",
          "infrared", "reddish", "evergreen", "purple", "red purple", "on;off;perhaps", "on on red"})
        EXPECT_EQ(drive::lenses_in(state, {"red", "yellow", "green"}), std::nullopt) << state;
    EXPECT_EQ(drive::lenses_in("on;off", {"red", "green"}), (std::vector{I, O}));
    EXPECT_EQ(drive::lenses_in("yellow", {"red", "green"}), std::nullopt) << "has none";
    EXPECT_EQ(drive::lenses_in("on", {"yellow"}), std::vector{I});
    EXPECT_EQ(drive::lenses_in("flashing", {"yellow"}), std::vector{F});
    const drive::SignalLens lens{.node = 0, .otherwise = true, .changes = {{2, Mode::Off}, {4, Mode::Flashing}}};
    const std::map<double, bool> wanted{{0, true}, {2, false}, {3.9, false}, {4.1, true}, {4.6, false}, {5.2, true}};
    for (const auto& [seconds, lit] : wanted) EXPECT_EQ(lens.shines(seconds), lit) << seconds;
}

// What is no state is named with its place, once; the light stays as it was.
TEST(RoadDrive, UnknownStatesOfTrafficLightsAreNoted) {
    scene::Scene scene;
    roads::RoadNetwork network;
    network.roads.resize(1);
    network.roads[0].signals.resize(1);
    network.roads[0].signals[0].id = "7";
    for (const char* colour : {"red", "yellow", "green"}) {
        scene::Node& node = scene.nodes.emplace_back();
        node.name = std::string("signal_7/") + colour, node.lamp = 0;
    }
    roads::EsminiRun run;
    run.signals = {{1, "7", "Green", "s.xosc:3"},
                   {2, "7", "purple", "s.xosc:4"},
                   {3, "7", "purple", "s.xosc:5"},
                   {4, "8", "red", "s.xosc:6"}};
    std::vector<std::string> notes;
    const std::vector<drive::SignalLens> lenses = drive::lenses_of(scene, network, run, notes);
    EXPECT_EQ(notes, (std::vector<std::string>{"s.xosc:4: 'purple' is no state of traffic light 7: it stays as it is",
                                               "s.xosc:6: there is no traffic light 8 in the roads"}));
    ASSERT_EQ(lenses.size(), 3u);
    for (const double seconds : {0.5, 1.5, 2.5, 9.0})
        for (size_t i = 0; i < 3; ++i) EXPECT_EQ(lenses[i].shines(seconds), i == (seconds < 1 ? 0u : 2u)) << seconds;
}

// The lights of a scenario shine as it sets them: green for cars, then yellow, red, and green again.
TEST(RoadDrive, ARunSwitchesItsTrafficLights) {
    const std::filesystem::path shared = std::string(VESPER_SHARED_DATA) + "/scenario";
    if (!std::filesystem::exists(shared)) GTEST_SKIP() << "no shared data";
    const std::filesystem::path roads = shared / "esmini/xodr/fabriksgatan_traffic_lights.xodr";
    const drive::Scenery scenery(roads, shared / "esmini-output/traffic_lights.csv",
                                 shared / "esmini/xosc/traffic_lights.xosc");
    const traffic::World world(scenery.world(), 1);
    const auto lit = [&](double seconds) {
        std::map<std::string, int> count;
        const gpu_scene::SceneFrame frame = scenery.frame(world.actors(), seconds, drive::DriveSettings());
        for (size_t i = 0; i < scenery.scene().nodes.size(); ++i) {
            const scene::Node& node = scenery.scene().nodes[i];
            if (node.lamp != scene::kNone && frame.dimming[i] > 0) ++count[scenery.scene().lamps[node.lamp].name];
        }
        return std::vector<int>{count["red signal"], count["yellow signal"], count["green signal"]};
    };
    EXPECT_EQ(lit(1), (std::vector<int>{2, 0, 1}));  // red for two people on foot
    EXPECT_EQ(lit(5), (std::vector<int>{2, 1, 0}));
    EXPECT_EQ(lit(8), (std::vector<int>{3, 0, 0}));
    EXPECT_EQ(lit(12), (std::vector<int>{1, 0, 2}));  // people walk
    EXPECT_EQ(lit(23), (std::vector<int>{2, 0, 1}));
    // Without a scenario cars wait.
    const drive::RoadWorld steady = drive::road_world(roads, {}, {});
    EXPECT_TRUE(steady.lenses.empty());
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
    expect_refused(common + kRoads + " --storyboard no.xosc --video a%d.png", {"--scenario"});
}

}  // namespace
}  // namespace vesper::test
