// Runs recorded by esmini. SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <fstream>

#include <gtest/gtest.h>

#include "roads/esmini_run.h"
#include "support/complaints.h"
#include "support/shared_data.h"
#include "support/temp_folder.h"

namespace vesper::test {

using roads::RunEntity, roads::RunPose, roads::read_esmini_run;

namespace {

const std::string kHeader = "time, id, name, x, y, z, h, p, r, speed, wheel_angle, wheel_rot\n";

class EsminiRuns : public testing::Test {
protected:
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    std::string complaint(const std::string& table) const {
        return complaint_of([&] { read_esmini_run(write("run.csv", table)); });
    }
    TempFolder folder_;
};

TEST_F(EsminiRuns, PosesLieBetweenRows) {
    const auto run = read_esmini_run(
        write("run.csv",
              "Version: 2, OpenDRIVE: a.xodr, 3DModel: \n" + kHeader +
                  "0.0, 7, Car, 0, 0, 0, 3.1, 0, 0, 10, 0.1, 6.0\n0.5, 7, Car, 5, 2, 1, -3.1, 0.2, 0, 12, 0.3, 0.2\n"));
    ASSERT_EQ(run.entities.size(), 1u);
    const RunEntity& car = run.entities[0];
    EXPECT_EQ(car.id, 7);
    EXPECT_EQ(run.duration, 0.5);
    const RunPose pose = roads::pose_at(car, 0.25);
    EXPECT_NEAR(pose.position.x, 2.5, 1e-12);
    EXPECT_NEAR(pose.position.z, 0.5, 1e-12);
    EXPECT_NEAR(std::abs(std::remainder(pose.heading, 2 * M_PI)), M_PI, 1e-9) << "the short way round";
    EXPECT_NEAR(pose.pitch, 0.1, 1e-12);
    EXPECT_NEAR(pose.speed, 11, 1e-12);
    EXPECT_EQ(roads::pose_at(car, -1).position.x, 0);
    EXPECT_EQ(roads::pose_at(car, 9).position.x, 5);
}

// The CSV logger has all entities in a row. One is gone after the first row, another comes later and is none of the
// header's.
TEST_F(EsminiRuns, TheTableOfTheCsvLoggerIsReadToo) {
    std::string header = "Index [-], TimeStamp [s], ";
    for (const std::string entity : {"#1 ", "#2 "})
        for (const char* column :
             {"Entity_Name [-]", "Entity_ID [-]", "Current_Speed [m/s]", "Wheel_Angle [deg]", "bb_x [m]", "bb_y [m]",
              "bb_z [m]", "bb_length [m]", "bb_width [m]", "bb_height [m]", "World_Position_X [m]",
              "World_Position_Y [m]", "World_Position_Z [m]", "lane_offset[m]", "World_Heading_Angle [rad]",
              "World_Pitch_Angle [rad]", "collision_ids"})
            header += entity + column + ", ";
    const auto block = [](const char* name, int id, double x) {
        char text[200];
        std::snprintf(text, sizeof text, "%s, %d, 12.5, 90, 1.4, 0, 0.7, 4.5, 1.9, 1.5, %g, 2, 0.3, 0.1, 0.5, 0.02, , ",
                      name, id, x);
        return std::string(text);
    };
    const auto run = read_esmini_run(
        write("run.csv", "esmini GIT REV: v3.6.0\nScenario File Name: a, b.xosc\nNumber of Vehicles: 2\n" + header +
                             "\n0, 0.000, " + block("Ego", 0, 10) + block("Gone", 1, 20) + "\n1, 0.100, " +
                             block("Ego", 0, 11) + "\n2, 0.200, " + block("Ego", 0, 12) + block("Late", 7, 70) +
                             block("Later", 8, 80) + "\n"));
    ASSERT_EQ(run.entities.size(), 4u);
    const RunEntity &ego = run.entities[0], &late = run.entities[2], &later = run.entities[3];
    EXPECT_EQ(ego.name, "Ego");
    EXPECT_EQ(ego.poses.size(), 3u);
    EXPECT_NEAR(roads::pose_at(ego, 0.15).position.x, 11.5, 1e-12);
    EXPECT_EQ(ego.poses[0].position, glm::dvec3(10, 2, 0.3));
    EXPECT_EQ(ego.poses[0].speed, 12.5);
    EXPECT_EQ(ego.poses[0].heading, 0.5);
    EXPECT_EQ(ego.poses[0].pitch, 0.02);
    EXPECT_EQ(ego.length, 4.5);
    EXPECT_EQ(ego.centre, glm::dvec3(1.4, 0, 0.7));
    EXPECT_EQ(run.entities[1].poses.size(), 1u);
    EXPECT_EQ(late.name, "Late");
    EXPECT_EQ(late.id, 7);
    EXPECT_EQ(late.poses[0].time, 0.2);
    EXPECT_EQ(later.poses[0].position.x, 80);
}

// Before 2.37.5 esmini's logger misspelt two of its columns.
TEST_F(EsminiRuns, OldTablesOfTheCsvLoggerAreRead) {
    const auto run = read_esmini_run(write("run.csv",
                                           "esmini GIT REV: v2.37.4\nIndex [-], TimeStamp [s], #1 Entitity_Name [-], "
                                           "#1 Entitity_ID [-], #1 Current_Speed [m/s], #1 World_Position_X [m], "
                                           "#1 World_Position_Y [m], #1 World_Position_Z [m], #1 World_Heading_Angle "
                                           "[rad], \n0, 0.000, Ego, 3, 5, 10, 0, 0, 0, \n"));
    EXPECT_EQ(run.entities[0].id, 3);
    EXPECT_EQ(run.entities[0].name, "Ego");
}

TEST_F(EsminiRuns, SpeedsFollowFromPlacesWhereTheTableHasNone) {
    std::string text = "\xEF\xBB\xBFtime, id, name, x, y, z, h, \r\n";
    for (int i = 0; i <= 100; ++i) {
        const double t = i * 0.05, x = t < 4 ? 10 * t : 40 + 10 * (t - 4) - (t - 4) * (t - 4) * 4;
        char line[100];
        std::snprintf(line, sizeof line, "%.3f, 3, Car, 5, %.4f, 0, %.6f\r\n", t, -x, -M_PI / 2);
        text += line;
    }
    const auto run = read_esmini_run(write("run.csv", text));
    EXPECT_NEAR(roads::pose_at(run.entities[0], 2).speed, 10, 0.01);
    EXPECT_NEAR(roads::pose_at(run.entities[0], 4.5).speed, 6, 0.1);
    // The same heading backwards.
    std::string back = "time, id, name, x, y, z, h\n0, 0, Car, 0, 0, 0, 0\n1, 0, Car, -3, 0, 0, 0\n";
    EXPECT_EQ(read_esmini_run(write("run.csv", back)).entities[0].poses[0].speed, -3);
}

TEST_F(EsminiRuns, ErrorsNameFileAndLine) {
    EXPECT_NE(complaint("a,b,c\n1,2,3\n").find("is no table of esmini"), std::string::npos);
    EXPECT_NE(complaint(kHeader).find("no row of the table"), std::string::npos);
    EXPECT_NE(complaint(kHeader + "0, 0, A, 1, 2\n").find("line 2"), std::string::npos)
        << complaint(kHeader + "0, 0, A, 1, 2\n");
    EXPECT_NE(complaint(kHeader + "0, 0, A, nan, 0, 0, 0, 0, 0, 0, 0, 0\n").find("x 'nan' is no number"),
              std::string::npos)
        << complaint(kHeader + "0, 0, A, nan, 0, 0, 0, 0, 0, 0, 0, 0\n");
    EXPECT_NE(complaint(kHeader + "1, 0, A, 0, 0, 0, 0, 0, 0, 0, 0, 0\n0, 0, A, 0, 0, 0, 0, 0, 0, 0, 0, 0\n")
                  .find("do not ascend"),
              std::string::npos);
    EXPECT_NE(complaint("time, id, name, x\n").find("no column 'y'"), std::string::npos);
    EXPECT_NE(complaint(kHeader + "0, 0, A, 0, 0, 0, 0, 0, 0, abc, 0, 0\n")
                  .find("run.csv: line 2: column 10: speed 'abc' is no number"),
              std::string::npos);
    EXPECT_NE(complaint(kHeader + "0, 1.5, A, 0, 0, 0, 0, 0, 0, 1, 0, 0\n")
                  .find("line 2: column 2: id '1.5' is no whole number"),
              std::string::npos);
    // What an entity has none of is empty, or NaN.
    const auto run = read_esmini_run(write("run.csv", kHeader + "0, 0, A, 0, 0, 0, 0, 0, 0, , nan, -nan\n"));
    EXPECT_EQ(run.entities[0].poses[0].speed, 0);
}

TEST(SharedRuns, AllAreRead) {
    if (!is_here(shared_data("scenario/esmini-output"))) GTEST_SKIP() << "no shared data";
    for (const char* name : {"cut-in", "light_state", "pedestrian", "traffic_lights"}) {
        const roads::EsminiRun run =
            read_esmini_run(shared_data(std::string("scenario/esmini-output/") + name + ".csv"));
        EXPECT_GE(run.entities.size(), 2u);
        EXPECT_GT(run.duration, 10);
    }
}

}  // namespace
}  // namespace vesper::test
