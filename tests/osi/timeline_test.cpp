// Moments between messages: poses, lamps that are stated and lamps that are not, and messages out of order.
// SPDX-License-Identifier: MIT
#include "osi/timeline.h"

#include <cmath>

#include <gtest/gtest.h>

#include "osi/run_messages.h"
#include "osi/trace.h"
#include "osi/written_messages.h"

namespace vesper::test {
namespace {

using osi::LampState, osi::Timeline;
using Kind = osi::MovingObject::Kind;

constexpr int64_t kMillisecond = 1'000'000;

osi::Message message(int64_t milliseconds, std::vector<osi::MovingObject> objects = {}) {
    return {.nanoseconds = 5'000'000'000 + milliseconds * kMillisecond, .host = {}, .objects = std::move(objects)};
}

osi::MovingObject car(double x, double speed, const osi::LightStates& lights = {}) {
    return {.id = 3,
            .kind = Kind::Car,
            .size = {4, 2, 1.5},
            .centre = {x, 0, 0.75},
            .velocity = glm::dvec3(speed, 0, 0),
            .lights = lights};
}

Timeline written() {
    Timeline timeline;
    for (osi::Message& each : osi::parse_trace(written_messages(), "a.osi").messages) timeline.add(std::move(each));
    return timeline;
}

TEST(Timeline, PosesLieBetweenMessages) {
    Timeline timeline = written();
    EXPECT_NEAR(timeline.latest(), 0.1, 1e-12);
    EXPECT_TRUE(timeline.at(-0.01).objects.empty());
    const osi::Moment moment = timeline.at(0.075);
    ASSERT_EQ(moment.objects.size(), 2u);
    EXPECT_NEAR(moment.objects[0].object.centre.x, 1.75, 1e-12);
    EXPECT_NEAR(moment.objects[0].speed, 8 * std::cos(0.5) + 6 * std::sin(0.5), 1e-12);
    EXPECT_EQ(timeline.at(9).objects[0].object.centre.x, 2) << "stays after the last";
    EXPECT_EQ(timeline.at(0).objects[0].object.centre.x, 1) << "and back";

    Timeline round;
    osi::MovingObject turns = car(0, 0);
    turns.yaw = 3.1;
    round.add(message(0, {turns}));
    turns.yaw = -3.1;
    round.add(message(100, {turns}));
    EXPECT_NEAR(std::abs(std::remainder(round.at(0.05).objects[0].object.yaw, 2 * M_PI)), M_PI, 1e-9);
}

TEST(Timeline, LampsAreLitAsTheirStatesSay) {
    Timeline timeline = written();
    const auto lights = [&](double seconds) { return timeline.at(seconds).objects[0].object.lights; };
    EXPECT_EQ(lights(0.04).brake, LampState::Off);
    EXPECT_EQ(lights(0.06).brake, LampState::On);
    EXPECT_EQ(lights(0.06).high, LampState::On);
    EXPECT_EQ(lights(0.06).left, LampState::Flashing);
    EXPECT_NEAR(timeline.at(0.06).objects[0].flashes_for, 0.01, 1e-12);
    EXPECT_EQ(lights(0.1).low, LampState::Off);
    EXPECT_EQ(lights(0.1).right, LampState::Off);
    EXPECT_NEAR(timeline.at(0.1).objects[0].flashes_for, 0.05, 1e-12) << "the left one goes on";
    EXPECT_EQ(lights(0.1).reversing, LampState::Off) << "nobody says";
    const osi::LightStates none = timeline.at(0.1).objects[1].object.lights;
    EXPECT_EQ(none.low, LampState::Off) << "a pedestrian has none";
}

// What the first message alone has still holds.
TEST(Timeline, WhatIsNotStatedAgainHolds) {
    Timeline timeline = written();
    const osi::Moment moment = timeline.at(0.1);
    EXPECT_EQ(moment.host, 7u);
    ASSERT_EQ(moment.traffic_lights.size(), 3u);
    EXPECT_EQ(moment.traffic_lights[0].light.state, LampState::On);
    EXPECT_NEAR(moment.traffic_lights[1].state_for, 0.1, 1e-12);
    EXPECT_EQ(moment.environment.sun_elevation, -0.2);
}

TEST(Timeline, ObjectsThatAreNotInAMessageAreGone) {
    Timeline timeline;
    timeline.add(message(0, {car(0, 10)}));
    timeline.add(message(100, {car(1, 10)}));
    timeline.add(message(200));
    timeline.add(message(300, {car(3, 10)}));
    EXPECT_EQ(timeline.at(0.15).objects.size(), 1u);
    EXPECT_EQ(timeline.at(0.25).objects.size(), 0u);
    EXPECT_EQ(timeline.at(0.3).objects.size(), 1u);
}

// 10 m/s, brakes with 2 m/s^2 from 4 s to 9 s, stands, goes backwards from 9.5 s.
TEST(Timeline, LampsThatNobodyStatesFollowFromTheMotion) {
    for (const bool with_speeds : {true, false}) {
        Timeline timeline;
        double x = 0;
        for (int i = 0; i <= 200; ++i) {
            const double t = i * 0.05, v = t < 4 ? 10 : t < 9 ? 10 - 2 * (t - 4) : t < 9.5 ? 0 : -1;
            osi::MovingObject object = car(x, v);
            if (!with_speeds) object.velocity.reset();
            timeline.add(message(50 * i, {object}));
            x += v * 0.05;
        }
        const auto lights = [&](double seconds) { return timeline.at(seconds).objects[0].object.lights; };
        EXPECT_EQ(lights(0.5).low, LampState::On);
        EXPECT_EQ(lights(0.5).tail, LampState::On);
        EXPECT_EQ(lights(0.5).high, LampState::Off);
        EXPECT_EQ(lights(3.9).brake, LampState::Off);
        for (double t = 4.3; t < 9.4; t += 0.1) EXPECT_EQ(lights(t).brake, LampState::On) << t << " " << with_speeds;
        EXPECT_EQ(lights(9.3).reversing, LampState::Off);
        EXPECT_EQ(lights(9.9).reversing, LampState::On);
    }
    // What is parked shows none.
    Timeline parked;
    for (int i = 0; i < 40; ++i) parked.add(message(50 * i, {car(5, 0)}));
    EXPECT_EQ(parked.at(1.9).objects[0].object.lights.brake, LampState::Off);
    // Slowing down by less is done by the engine.
    for (const double deceleration : {0.65, 0.75}) {
        Timeline slower;
        for (int i = 0; i < 100; ++i) slower.add(message(50 * i, {car(i, 20 - deceleration * 0.05 * i)}));
        EXPECT_EQ(slower.at(4).objects[0].object.lights.brake, deceleration > 0.7 ? LampState::On : LampState::Off);
    }
}

TEST(Timeline, MessagesMayComeInAnyOrderUntilTheyAreNeeded) {
    Timeline timeline(false);
    std::vector<int64_t> used;
    timeline.on_use = [&](const osi::Message& m) { used.push_back((m.nanoseconds - 5'000'000'000) / kMillisecond); };
    EXPECT_EQ(timeline.add(message(0, {car(0, 10)})), Timeline::Added::Accepted);
    EXPECT_EQ(timeline.add(message(200, {car(2, 10)})), Timeline::Added::Accepted);
    EXPECT_EQ(timeline.add(message(100, {car(1.5, 10)})), Timeline::Added::Accepted) << "not too late";
    EXPECT_EQ(timeline.add(message(100, {car(1, 10)})), Timeline::Added::Repeated);
    EXPECT_NEAR(timeline.at(0.05).objects[0].object.centre.x, 0.75, 1e-12);
    EXPECT_EQ(timeline.add(message(60, {car(9, 10)})), Timeline::Added::Late) << "a moment was made without it";
    EXPECT_EQ(timeline.add(message(-50, {car(9, 10)})), Timeline::Added::Late);
    EXPECT_EQ(timeline.add(message(150, {car(1.8, 10)})), Timeline::Added::Accepted);
    timeline.at(0.12);
    EXPECT_EQ(used, (std::vector<int64_t>{0, 100, 150}));
    timeline.at(5);
    EXPECT_EQ(used, (std::vector<int64_t>{0, 100, 150, 200}));
}

TEST(Timeline, OfTwoObjectsWithOneIdTheFirstCounts) {
    Timeline timeline;
    timeline.add(message(0, {car(1, 0, {.brake = LampState::Off}), car(2, 0, {.brake = LampState::On})}));
    EXPECT_EQ(timeline.at(0).objects[0].object.lights.brake, LampState::Off);
}

// Messages that nobody asks for do not fill the memory, and neither do traffic lights without number.
TEST(Timeline, HasBounds) {
    Timeline live(false);
    osi::Message large = message(0);
    large.objects.assign(10'000, car(0, 0));
    int accepted = 0;
    for (int i = 0; i < 500; ++i) {
        large.nanoseconds += kMillisecond;
        accepted += live.add(large) == Timeline::Added::Accepted;
    }
    EXPECT_GT(accepted, 50);
    EXPECT_LT(accepted, 400);
    EXPECT_EQ(live.add(large), Timeline::Added::CrowdedOut);
    live.at(0.4);
    large.nanoseconds += kMillisecond;
    EXPECT_EQ(live.add(large), Timeline::Added::Accepted) << "there is room again";

    Timeline lights;
    for (int i = 0; i < 4; ++i) {
        osi::Message m = message(i);
        for (uint64_t k = 0; k < 9000; ++k) m.traffic_lights.push_back({.id = 100'000 - 9000 * uint64_t(i) - k});
        lights.add(m);
    }
    EXPECT_EQ(lights.at(1).traffic_lights.size(), size_t(osi::kMostObjects));
}

// What a live timeline needed, read again, gives the same moments to the bit.
TEST(Timeline, ARecordingOfWhatWasNeededHasTheSameMoments) {
    Timeline live(false);
    std::string kept;
    live.on_use = [&](const osi::Message& m) { kept += osi::trace_bytes_of(m); };
    std::vector<std::pair<double, osi::Moment>> shown;
    const int order[]{0, 2, 1, 3, 5, 4, 6, 9, 8, 7, 10, 12, 11, 13};
    double seconds = 0;
    for (const int i : order) {
        osi::MovingObject object = car(0.7 * i, 10 + 0.1 * i * i);
        object.lights.left = i > 5 ? LampState::Flashing : LampState::Off;
        object.lights.low = i % 3 == 0 ? LampState::On : LampState::Unknown;
        live.add(message(50 * i, {object}));
        if (live.latest() - 0.06 > seconds) {
            seconds = live.latest() - 0.06;
            shown.emplace_back(seconds, live.at(seconds));
        }
    }
    ASSERT_GT(shown.size(), 5u);
    Timeline again;
    for (osi::Message& each : osi::parse_trace(std::vector<uint8_t>(kept.begin(), kept.end()), "k.osi").messages)
        again.add(std::move(each));
    for (const auto& [at, moment] : shown) {
        const osi::Moment same = again.at(at);
        ASSERT_EQ(same.objects.size(), moment.objects.size());
        for (size_t i = 0; i < same.objects.size(); ++i) {
            EXPECT_EQ(same.objects[i].object.centre, moment.objects[i].object.centre) << at;
            EXPECT_EQ(same.objects[i].speed, moment.objects[i].speed);
            EXPECT_TRUE(same.objects[i].object.lights == moment.objects[i].object.lights) << at;
            EXPECT_EQ(same.objects[i].flashes_for, moment.objects[i].flashes_for);
        }
    }
}

TEST(Timeline, RunsOfEsminiAreMessages) {
    roads::EsminiRun run;
    run.entities.resize(2);
    run.entities[0].poses = {{.time = 0, .position = {10, 0, 1}, .speed = 4},
                             {.time = 1, .position = {14, 0, 1}, .speed = 4}};
    run.entities[0].length = 5, run.entities[0].width = 2, run.entities[0].height = 1.6;
    run.entities[0].centre = {1.4, 0, 0.8};
    run.entities[1].kind = roads::RunEntity::Kind::Pedestrian;
    run.entities[1].poses = {{.time = 0.5, .position = {0, 5, 0}, .heading = M_PI / 2}};
    Timeline timeline;
    for (osi::Message& each : osi::messages_of(run)) timeline.add(std::move(each));
    EXPECT_EQ(timeline.at(0.25).objects.size(), 1u);
    const osi::Moment moment = timeline.at(0.5);
    ASSERT_EQ(moment.objects.size(), 2u);
    EXPECT_LT(glm::distance(moment.objects[0].object.centre, glm::dvec3(13.4, 0, 1.8)), 1e-12);
    EXPECT_NEAR(moment.objects[0].speed, 4, 1e-12);
    EXPECT_LT(glm::distance(moment.objects[1].object.centre, glm::dvec3(0, 5, 0.875)), 1e-12);
    EXPECT_EQ(timeline.at(1).objects.size(), 1u);
}

}  // namespace
}  // namespace vesper::test
