// Driving on roads of others, among what was recorded on them. SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "places.h"
#include "road_world.h"
#include "roads/opendrive.h"
#include "scenery.h"
#include "support/program.h"

namespace vesper::test {
namespace {

const std::string kRoads = std::string(VESPER_SOURCE_DIR) + "/data/rivoli/rivoli.xodr";

// Two entities: one drives towards y, slows down and is gone after 2 s; one stands from 1 s on.
const char* kRun = "time, id, name, x, y, z, h, p, r, speed, wheel_angle, wheel_rot\n"
                   "0.0, 0, Car, 10.0, 0.0, 0.0, 1.5707963, 0, 0, 10, 0, 0\n"
                   "1.0, 0, Car, 10.0, 10.0, 0.0, 1.5707963, 0, 0, 10, 0, 0\n"
                   "1.0, 1, Pedestrian, 20.0, 5.0, 0.1, 0, 0, 0, 0, 0, 0\n"
                   "2.0, 0, Car, 10.0, 16.0, 0.0, 1.7707963, 0, 0, 2, 0, 0\n"
                   "2.0, 1, Pedestrian, 20.0, 5.0, 0.1, 0, 0, 0, 0, 0, 0\n"
                   "4.0, 1, Pedestrian, 20.0, 5.0, 0.1, 0, 0, 0, 0, 0, 0\n";

TEST(RoadDrive, ARunIsWhereItWasRecorded) {
    const TempFolder folder;
    const RoadNetwork network = read_opendrive(kRoads);
    const RoadWorld made = road_world(kRoads, folder.write("run.csv", kRun), {});
    ASSERT_EQ(made.world.world.recordings.size(), 2u);
    EXPECT_TRUE(made.world.world.cars.empty());
    World world(std::make_shared<const WorldDescription>(made.world.world), 1);
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
    const RoadWorld made = road_world(kRoads, {}, {});
    EXPECT_FALSE(made.world.world.cars.empty());
    EXPECT_FALSE(made.world.world.barriers.empty());
    World world(std::make_shared<const WorldDescription>(made.world.world), 1);
    for (int i = 0; i < 60 * 30; ++i) {
        world.step({.autopilot = true}, 1.0 / 60);
        ASSERT_LT(made.world.world.lanes[world.driver_lane()].beside(world.driver().position).distance, 1) << i;
    }
    EXPECT_GT(world.driver().odometer, 100);
}

TEST(RoadDrive, PlainBodiesHaveTheirLamps) {
    const TempFolder folder;
    const Scenery scenery(kRoads, folder.write("run.csv", kRun));
    std::vector<std::string> names;
    for (const LampGroup& group : scenery.lamp_groups()) names.push_back(group.name);
    for (const char* name : {"low beam", "high beam", "tail lamp", "brake lamp", "left front indicator", "right rear indicator"}) EXPECT_TRUE(std::find(names.begin(), names.end(), name) != names.end()) << name;
    EXPECT_THROW(Scenery(std::string(VESPER_SOURCE_DIR) + "/data/rivoli/rivoli.world.json", folder / "run.csv"), Error);
}

class RoadDriveProgram : public ProgramTest {
protected:
    RoadDriveProgram() : ProgramTest(VESPER_DRIVE) {}
};

TEST_F(RoadDriveProgram, ReplaysARunToTheBit) {
    folder.write("run.csv", kRun);
    const std::string common = "--headless --size 64x40 ";
    ASSERT_EQ(run(common + kRoads + " --scenario run.csv --autopilot --seconds 0.5 --fps 10 --record d.json --video a%d.png"), 0) << said;
    ASSERT_EQ(run(common + "--replay d.json --video b%d.png"), 0) << said;
    for (int i = 0; i < 6; ++i) EXPECT_EQ(read_text(folder / ("a" + std::to_string(i) + ".png")), read_text(folder / ("b" + std::to_string(i) + ".png"))) << i;
    expect_refused(common + kRoads + " --scenario no.csv --video a%d.png", {"no.csv"});
    expect_refused(common + kRoads + " --storyboard no.xosc --video a%d.png", {"--scenario"});
}

}  // namespace
}  // namespace vesper::test
