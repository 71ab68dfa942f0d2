// Runs recorded by esmini, and the lamps of their scenarios. SPDX-License-Identifier: MIT
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "roads/opendrive.h"
#include "roads/run_texts.h"
#include "scene/scene_files.h"

namespace vesper::test {

using roads::RunEntity, roads::RunLamp, roads::RunPose, roads::lamp_at, roads::read_esmini_run;

namespace {

using Mode = roads::LampEvent::Mode;

class EsminiRuns : public RunFiles {};

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
    EXPECT_NEAR(pose.wheel_angle, 0.2, 1e-12);
    EXPECT_NEAR(pose.wheel_rotation, 6 + (0.2 + 2 * M_PI - 6) / 2, 1e-9) << "forwards";
    EXPECT_EQ(roads::pose_at(car, -1).position.x, 0);
    EXPECT_EQ(roads::pose_at(car, 9).position.x, 5);
    EXPECT_FALSE(roads::is_there(car, 0.6));
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
    EXPECT_NEAR(ego.poses[0].wheel_angle, M_PI / 2, 1e-12);
    EXPECT_EQ(ego.length, 4.5);
    EXPECT_EQ(ego.centre, glm::dvec3(1.4, 0, 0.7));
    EXPECT_EQ(run.entities[1].poses.size(), 1u);
    EXPECT_EQ(late.name, "Late");
    EXPECT_EQ(late.id, 7);
    EXPECT_FALSE(roads::is_there(late, 0.1));
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

// Whoever gives a catalog, or a scenario of long ago, learns why nothing is lit.
TEST_F(EsminiRuns, ScenariosThatSayNothingAreNoted) {
    const auto table = write("run.csv", kHeader + "0.0, 0, Ego, 0, 0, 0, 0, 0, 0, 0, 0, 0\n");
    const auto notes = [&](const std::string& text) {
        std::string all;
        for (const std::string& note : read_esmini_run(table, write("run.xosc", text)).notes) all += note + "\n";
        return all;
    };
    EXPECT_NE(
        notes("<OpenSCENARIO><Catalog name=\"c\"/></OpenSCENARIO>").find("run.xosc:1: OpenSCENARIO: has no Storyboard"),
        std::string::npos);
    EXPECT_NE(notes("<OpenSCENARIO>\n<FileHeader revMajor=\"0\" revMinor=\"9\"/><Storyboard/></OpenSCENARIO>")
                  .find("run.xosc:2: FileHeader: OpenSCENARIO 0.9"),
              std::string::npos);
    EXPECT_EQ(notes(scenario("")), "");
}

// Brake lamps follow from speeds that only the places tell.
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
    EXPECT_EQ(lamp_at(run.entities[0], RunLamp::Brake, 2).level, 0);
    EXPECT_EQ(lamp_at(run.entities[0], RunLamp::Brake, 4.5).level, 1);
    // The same heading backwards.
    std::string back = "time, id, name, x, y, z, h\n0, 0, Car, 0, 0, 0, 0\n1, 0, Car, -3, 0, 0, 0\n";
    EXPECT_EQ(read_esmini_run(write("run.csv", back)).entities[0].poses[0].speed, -3);
}

TEST_F(EsminiRuns, LampsFollowFromTheMotionWhereNothingIsStated) {
    const auto run = read_esmini_run(write("run.csv", braking_run()));
    EXPECT_EQ(lamp_at(run.entities[0], RunLamp::LowBeam, 0).level, 1);
    EXPECT_EQ(lamp_at(run.entities[0], RunLamp::Brake, 3.5).level, 0);
    for (double t = 4.3; t < 9.4; t += 0.1) EXPECT_EQ(lamp_at(run.entities[0], RunLamp::Brake, t).level, 1) << t;
    EXPECT_EQ(lamp_at(run.entities[0], RunLamp::Reversing, 9).level, 0);
    EXPECT_EQ(lamp_at(run.entities[0], RunLamp::Reversing, 9.7).level, 1);
    EXPECT_EQ(lamp_at(run.entities[0], RunLamp::IndicatorLeft, 5).level, 0);
}

TEST_F(EsminiRuns, EventsSetLamps) {
    const std::string text =
        scenario(event("one",
                       lamp("indicatorLeft", "flashing",
                            "luminousIntensity=\"${2 * $cd}\" flashingOnDuration=\"0.4\" flashingOffDuration=\"0.3\""),
                       at_time("$when")) +
                     event("two", lamp("highBeam", "on", "luminousIntensity=\"30000\"", "transitionTime=\"1\""),
                           "<ByValueCondition><StoryboardElementStateCondition storyboardElementType=\"event\" "
                           "storyboardElementRef=\"one\" state=\"runningState\"/></ByValueCondition>",
                           "delay=\"1.5\" conditionEdge=\"rising\"") +
                     event("three", lamp("brakeLights", "on"),
                           "<ByEntityCondition><TriggeringEntities triggeringEntitiesRule=\"any\"><EntityRef "
                           "entityRef=\"Ego\"/></TriggeringEntities><EntityCondition><SpeedCondition value=\"5\" "
                           "rule=\"lessThan\"/></EntityCondition></ByEntityCondition>"),
                 "<ParameterDeclaration name=\"when\" value=\"2\"/><ParameterDeclaration name=\"cd\" value=\"250\"/>");
    const auto run = read_esmini_run(write("run.csv", braking_run()), write("run.xosc", text));
    EXPECT_TRUE(run.notes.empty()) << run.notes[0];
    EXPECT_EQ(run.road_file, "a.xodr");
    const RunEntity& ego = run.entities[0];
    EXPECT_EQ(ego.kind, RunEntity::Kind::Truck);
    EXPECT_EQ(ego.length, 8);
    EXPECT_EQ(ego.centre.x, 1.5);
    ASSERT_EQ(events_of(run, RunLamp::IndicatorLeft).size(), 1u);
    EXPECT_NEAR(events_of(run, RunLamp::IndicatorLeft)[0].time, 2, 1e-9);
    EXPECT_EQ(lamp_at(ego, RunLamp::IndicatorLeft, 2.39).level, 1);
    EXPECT_EQ(lamp_at(ego, RunLamp::IndicatorLeft, 2.41).level, 0);
    EXPECT_EQ(lamp_at(ego, RunLamp::IndicatorLeft, 2.71).level, 1);
    EXPECT_EQ(lamp_at(ego, RunLamp::IndicatorLeft, 2.1).intensity, 500);
    // 1.5 s after the step in which the first began; it goes on as long as its lamp flashes.
    ASSERT_EQ(events_of(run, RunLamp::HighBeam).size(), 1u);
    EXPECT_NEAR(events_of(run, RunLamp::HighBeam)[0].time, 3.5, 0.11);
    EXPECT_NEAR(lamp_at(ego, RunLamp::HighBeam, events_of(run, RunLamp::HighBeam)[0].time + 0.5).level, 0.5, 1e-9);
    ASSERT_EQ(events_of(run, RunLamp::Brake).size(), 1u) << "as stated, not as driven";
    EXPECT_NEAR(events_of(run, RunLamp::Brake)[0].time, 6.5, 0.11);
}

// The third ends the first, which the fourth waits for; the second does not begin beside another.
TEST_F(EsminiRuns, EventsOverrideAndSkip) {
    const auto with_priority = [](const char* priority, std::string text) {
        return text.replace(text.find("parallel"), 8, priority);
    };
    const std::string seven_seconds =
        "<PrivateAction><LongitudinalAction><SpeedAction><SpeedActionDynamics dynamicsShape=\"linear\" value=\"7\" "
        "dynamicsDimension=\"time\"/>"
        "<SpeedActionTarget><AbsoluteTargetSpeed "
        "value=\"10\"/></SpeedActionTarget></SpeedAction></LongitudinalAction></PrivateAction>";
    const auto begin_of_second_and_fourth = [&](const char* priority_of_third) {
        const std::string text =
            scenario(event("first", seven_seconds, at_time("1")) +
                     with_priority("skip", event("second", lamp("brakeLights", "on"), at_time("2"))) +
                     with_priority(priority_of_third, event("third", lamp("indicatorLeft", "on"), at_time("3"))) +
                     event("fourth", lamp("highBeam", "on"),
                           "<ByValueCondition><StoryboardElementStateCondition storyboardElementType=\"event\" "
                           "storyboardElementRef=\"first\" state=\"completeState\"/></ByValueCondition>"));
        const auto run = read_esmini_run(write("run.csv", braking_run()), write("run.xosc", text));
        const auto &second = events_of(run, RunLamp::Brake), &fourth = events_of(run, RunLamp::HighBeam);
        EXPECT_EQ(second.size(), 1u);
        EXPECT_EQ(fourth.size(), 1u);
        return second.empty() || fourth.empty() ? std::pair(0.0, 0.0) : std::pair(second[0].time, fourth[0].time);
    };
    const auto [second, fourth] = begin_of_second_and_fourth("override");
    EXPECT_NEAR(second, 3.05, 0.06);
    EXPECT_NEAR(fourth, 3, 0.06);
    const auto [last, complete] = begin_of_second_and_fourth("parallel");
    EXPECT_NEAR(last, 8.05, 0.06);
    EXPECT_NEAR(complete, 8, 0.06);
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
    EXPECT_NE(
        complaint(kHeader + "0, 0, A, 0, 0, 0, 0, 0, 0, 1, 0, 1e10\n").find("line 2: column 12: wheel_rot '1e10'"),
        std::string::npos);
    EXPECT_NE(complaint(kHeader + "0, 1.5, A, 0, 0, 0, 0, 0, 0, 1, 0, 0\n")
                  .find("line 2: column 2: id '1.5' is no whole number"),
              std::string::npos);
    // What an entity has none of is empty, or NaN.
    const auto run = read_esmini_run(write("run.csv", kHeader + "0, 0, A, 0, 0, 0, 0, 0, 0, , nan, -nan\n"));
    EXPECT_EQ(run.entities[0].poses[0].speed, 0);
    EXPECT_EQ(run.entities[0].poses[0].wheel_rotation, 0);
    EXPECT_NE(complaint(braking_run(), "<OpenDRIVE/>").find("run.xosc:1: OpenDRIVE: the root"), std::string::npos);
    EXPECT_NE(complaint(braking_run(), scenario(event("e", lamp("lowBeam", "on"), at_time("$nothing"))))
                  .find("there is no parameter"),
              std::string::npos);
    EXPECT_NE(complaint(braking_run(), scenario(event("e", lamp("lowBeam", "on"), at_time("${1 +}"))))
                  .find("is no expression"),
              std::string::npos);
}

// Conditions are asked every step, each for all its entities.
TEST_F(EsminiRuns, StoryboardsThatAskTooMuchAreRefused) {
    std::string table = kHeader, entities, conditions;
    for (int i = 0; i < 20000; ++i) table += std::to_string(i) + ", 0, Ego, 0, 0, 0, 0, 0, 0, 1, 0, 0\n";
    const auto asked = [&](int groups, int times) {
        std::string who, trigger;
        for (int i = 0; i < times; ++i) who += "<EntityRef entityRef=\"Ego\"/>";
        for (int i = 0; i < groups; ++i)
            trigger += "<ConditionGroup><Condition><ByEntityCondition><TriggeringEntities>" + who +
                       "</TriggeringEntities><EntityCondition><SpeedCondition value=\"9\" "
                       "rule=\"greaterThan\"/></EntityCondition></ByEntityCondition></Condition></ConditionGroup>";
        return complaint(table, scenario("<Event name=\"e\"><StartTrigger>" + trigger + "</StartTrigger></Event>"));
    };
    EXPECT_EQ(asked(10, 10), "");
    EXPECT_NE(asked(13000, 1).find("run.xosc:1: Storyboard: too many elements and conditions"), std::string::npos);
    EXPECT_NE(asked(10, 2500).find("too many elements and conditions"), std::string::npos);
}

// At rest for a while: also where it was already, and where rows are many.
TEST_F(EsminiRuns, StandingStillIsJudgedByTheLastMovement) {
    const auto at = [&](const char* duration) {
        const std::string condition =
            std::string(
                "<ByEntityCondition><TriggeringEntities><EntityRef "
                "entityRef=\"Ego\"/></TriggeringEntities><EntityCondition><StandStillCondition duration=\"") +
            duration + "\"/></EntityCondition></ByEntityCondition>";
        const auto run = read_esmini_run(write("run.csv", braking_run()),
                                         write("run.xosc", scenario(event("e", lamp("highBeam", "on"), condition))));
        const auto& events = events_of(run, RunLamp::HighBeam);
        return events.empty() ? -1 : events[0].time;
    };
    EXPECT_NEAR(at("0.3"), 9.3, 0.051) << "it stands from 9 to 9.5 s";
    EXPECT_EQ(at("0.6"), -1);
}

TEST_F(EsminiRuns, WhatIsNotUnderstoodIsNoted) {
    const auto run = read_esmini_run(
        write("run.csv", braking_run()),
        write("run.xosc",
              scenario(event("e", lamp("lowBeam", "on"),
                             "<ByEntityCondition><TriggeringEntities><EntityRef "
                             "entityRef=\"Ego\"/></TriggeringEntities><EntityCondition><CollisionCondition/>"
                             "</EntityCondition></ByEntityCondition>"))));
    ASSERT_EQ(run.notes.size(), 1u);
    EXPECT_NE(run.notes[0].find("CollisionCondition that cannot be judged"), std::string::npos) << run.notes[0];
}

roads::EsminiRun shared_run(const std::string& name, const roads::RoadNetwork* roads = nullptr) {
    return read_esmini_run(shared_data("scenario/esmini-output/" + name + ".csv"),
                           shared_data("scenario/esmini/xosc/" + name + ".xosc"), roads);
}

/// When the speed of an entity first passes a value from `from` on.
double first_time(const RunEntity& entity, double from, const std::function<bool(const RunPose&)>& when) {
    for (const RunPose& pose : entity.poses)
        if (pose.time >= from && when(pose)) return pose.time;
    return 1e9;
}

// The recorded motion says when esmini itself started the events that set lamps and speeds together.
TEST(SharedRuns, LampsOfLightState) {
    if (!is_here(shared_data("scenario/esmini-output"))) GTEST_SKIP() << "no shared data";
    const roads::EsminiRun run = shared_run("light_state");
    // The scenario says 2 s.
    EXPECT_NEAR(events_of(run, RunLamp::FogFront)[1].time, 2, 0.11);
    EXPECT_EQ(events_of(run, RunLamp::FogFront)[1].intensity, 1500);
    EXPECT_EQ(events_of(run, RunLamp::IndicatorLeft)[0].mode, Mode::Flashing);
    ASSERT_EQ(run.time_of_day.size(), 4u);
    EXPECT_EQ(run.time_of_day[2].state, "2025-06-13T00:00:00.000+00:00");
    EXPECT_NEAR(lamp_at(run.entities[1], RunLamp::LowBeam, 39).intensity, 4000, 1e-9);
    EXPECT_EQ(lamp_at(run.entities[1], RunLamp::LowBeam, 20).level, 0) << "stated to be off";
    const RunEntity& car = run.entities[0];
    const double braking = first_time(car, 16, [](const RunPose& p) { return p.speed < 14.999; });
    const double backwards = first_time(car, 20, [](const RunPose& p) { return p.speed < -0.001; });
    EXPECT_NEAR(events_of(run, RunLamp::Brake)[0].time, braking, 0.15);
    EXPECT_NEAR(events_of(run, RunLamp::Reversing)[0].time, backwards, 0.15);
    EXPECT_NEAR(car.length, 5.04, 1e-9);
}

// The left indicator and a lane change belong to one event: the car leaves the circle of its lane when it begins to
// flash.
TEST(SharedRuns, IndicatorsBeginWithTheLaneChange) {
    if (!is_here(shared_data("scenario/esmini-output"))) GTEST_SKIP() << "no shared data";
    const roads::EsminiRun run = shared_run("light_state");
    const roads::RoadNetwork roads = roads::read_opendrive(shared_data("scenario/esmini/xodr/circle_300m.xodr"));
    const roads::PlanGeometry& circle = roads.roads[0].plan[0];
    const double radius = 1 / circle.curvature;
    const glm::dvec2 middle{circle.x - std::sin(circle.heading) * radius, circle.y + std::cos(circle.heading) * radius};
    const auto from_middle = [&](const RunPose& p) { return glm::distance(glm::dvec2(p.position), middle); };
    const RunEntity& car = run.entities[0];
    const double lane = from_middle(car.poses[0]);
    const double leaves = first_time(car, 5, [&](const RunPose& p) { return std::abs(from_middle(p) - lane) > 0.02; });
    EXPECT_NEAR(events_of(run, RunLamp::IndicatorLeft)[0].time, leaves, 0.25);
}

TEST(SharedRuns, TrafficLightsTurnWhereTheCarCounts) {
    if (!is_here(shared_data("scenario/esmini-output"))) GTEST_SKIP() << "no shared data";
    const roads::RoadNetwork roads =
        roads::read_opendrive(shared_data("scenario/esmini/xodr/fabriksgatan_traffic_lights.xodr"));
    const roads::EsminiRun run = shared_run("traffic_lights", &roads);
    for (const std::string& note : run.notes)
        EXPECT_NE(note.find("a distance in the road is measured straight"), std::string::npos) << note;
    EXPECT_GT(run.signals.size(), 6u);
    for (size_t i = 1; i < run.signals.size(); ++i) EXPECT_GE(run.signals[i].time, run.signals[i - 1].time);
    // The car stops at the red light, and goes when it is green again.
    const RunEntity& car = run.entities[0];
    const double stands = first_time(car, 0, [](const RunPose& p) { return p.speed < 0.01; });
    EXPECT_EQ(roads::signal_at(run, "1", 0), "off;off;on");
    EXPECT_EQ(roads::signal_at(run, "1", stands), "on;off;off");
    const double goes = first_time(car, stands + 1, [](const RunPose& p) { return p.speed > 0.05; });
    EXPECT_EQ(roads::signal_at(run, "1", goes + 0.3), "off;off;on");
}

TEST(SharedRuns, AllAreRead) {
    if (!is_here(shared_data("scenario/esmini-output"))) GTEST_SKIP() << "no shared data";
    for (const char* name : {"cut-in", "light_state", "pedestrian", "traffic_lights"}) {
        const roads::EsminiRun run = shared_run(name);
        EXPECT_GE(run.entities.size(), 2u);
        EXPECT_GT(run.duration, 10);
        for (const RunEntity& entity : run.entities)
            EXPECT_TRUE(entity.length > 0 || entity.kind == RunEntity::Kind::Object) << entity.name;
    }
}

}  // namespace
}  // namespace vesper::test
