// Messages of other simulators: what is read of them, and what is written. SPDX-License-Identifier: MIT
#include "osi/message.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include <osi/osi.pb.h>

#include "osi/written_messages.h"
#include "support/complaints.h"

namespace vesper::test {
namespace {

using osi::LampState;
using Colour = osi::TrafficLight::Colour;

osi::Message written(size_t i) {
    const std::vector<uint8_t> all = written_messages();
    return osi::parse_message(std::span(all).subspan(kWrittenMessages[i].begin, kWrittenMessages[i].length));
}

TEST(OsiMessage, IsWhatItsWriterSaid) {
    const osi::Message first = written(0);
    EXPECT_EQ(first.nanoseconds, 100'000'000'000);
    EXPECT_EQ(first.host, 7u);
    ASSERT_EQ(first.objects.size(), 2u);
    const osi::MovingObject &car = first.objects[0], &pedestrian = first.objects[1];
    EXPECT_EQ(car.id, 7u);
    EXPECT_EQ(car.kind, osi::MovingObject::Kind::Car);
    EXPECT_EQ(car.model, "cars/audi.osgb");
    EXPECT_EQ(car.size, glm::dvec3(4.4, 1.8, 1.5));
    EXPECT_EQ(car.centre, glm::dvec3(1, 2, 0.75));
    EXPECT_EQ(car.yaw, 0.5);
    EXPECT_EQ(car.velocity, glm::dvec3(8, 6, 0));
    const osi::LightStates lights{.low = LampState::On,
                                  .high = LampState::Off,
                                  .tail = LampState::On,
                                  .brake = LampState::Off,
                                  .left = LampState::Off,
                                  .right = LampState::Off,
                                  .front_fog = LampState::On,
                                  .rear_fog = LampState::Off};
    EXPECT_TRUE(car.lights == lights);
    EXPECT_EQ(pedestrian.kind, osi::MovingObject::Kind::Pedestrian);
    EXPECT_EQ(pedestrian.velocity, std::nullopt);
    EXPECT_TRUE(pedestrian.lights == osi::LightStates{});
    ASSERT_EQ(first.traffic_lights.size(), 3u);
    const Colour colours[]{Colour::Red, Colour::Yellow, Colour::Green};
    const LampState states[]{LampState::On, LampState::Flashing, LampState::Off};
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(first.traffic_lights[i].signal, "12");
        EXPECT_EQ(first.traffic_lights[i].colour, colours[i]);
        EXPECT_EQ(first.traffic_lights[i].state, states[i]);
        EXPECT_NEAR(first.traffic_lights[i].position.z, 3 - 0.3 * double(i), 1e-12);
    }
    ASSERT_TRUE(first.environment);
    EXPECT_EQ(first.environment->sun_elevation, -0.2);
    EXPECT_EQ(first.environment->time_of_day, 79200);
    EXPECT_EQ(first.environment->ambient_level, 2);
    EXPECT_TRUE(first.environment->fog);
    EXPECT_FALSE(first.environment->precipitation);
}

TEST(OsiMessage, LightsAndViewsToo) {
    const osi::Message second = written(1), third = written(2);
    const osi::LightStates &warns = second.objects[0].lights, &turns = third.objects[0].lights;
    EXPECT_EQ(second.host, std::nullopt);
    EXPECT_EQ(second.environment, std::nullopt);
    EXPECT_TRUE(warns.left == LampState::Flashing && warns.right == LampState::Flashing);
    EXPECT_TRUE(warns.brake == LampState::On && warns.high == LampState::On && warns.rear_fog == LampState::On);
    EXPECT_TRUE(turns.left == LampState::Flashing && turns.right == LampState::Off);
    EXPECT_TRUE(turns.brake == LampState::On && turns.low == LampState::Off);
    EXPECT_EQ(third.nanoseconds, 100'100'000'000);
    EXPECT_EQ(third.host, 7u) << "of the view";
    EXPECT_EQ(third.objects[0].centre.x, 2);
}

TEST(OsiMessage, IsReadAsItWasWritten) {
    for (size_t i = 0; i < 3; ++i) {
        const osi::Message one = written(i);
        const std::string bytes = osi::bytes_of(one);
        const osi::Message same = osi::parse_message({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
        EXPECT_EQ(same.nanoseconds, one.nanoseconds);
        EXPECT_EQ(same.host, one.host);
        EXPECT_EQ(same.environment, one.environment);
        ASSERT_EQ(same.objects.size(), one.objects.size());
        for (size_t k = 0; k < one.objects.size(); ++k) {
            EXPECT_EQ(same.objects[k].id, one.objects[k].id);
            EXPECT_EQ(same.objects[k].kind, one.objects[k].kind);
            EXPECT_EQ(same.objects[k].model, one.objects[k].model);
            EXPECT_EQ(same.objects[k].centre, one.objects[k].centre);
            EXPECT_EQ(same.objects[k].yaw, one.objects[k].yaw);
            EXPECT_EQ(same.objects[k].velocity, one.objects[k].velocity);
            EXPECT_TRUE(same.objects[k].lights == one.objects[k].lights) << i << " " << k;
        }
        ASSERT_EQ(same.traffic_lights.size(), one.traffic_lights.size());
        for (size_t k = 0; k < one.traffic_lights.size(); ++k) {
            EXPECT_EQ(same.traffic_lights[k].signal, one.traffic_lights[k].signal);
            EXPECT_EQ(same.traffic_lights[k].colour, one.traffic_lights[k].colour);
            EXPECT_EQ(same.traffic_lights[k].state, one.traffic_lights[k].state);
            EXPECT_EQ(same.traffic_lights[k].position, one.traffic_lights[k].position);
        }
    }
    // Times before 0, and every kind.
    osi::Message before{.nanoseconds = -1'500'000'000};
    for (int kind = 0; kind <= int(osi::MovingObject::Kind::Object); ++kind)
        before.objects.push_back({.id = uint64_t(kind), .kind = osi::MovingObject::Kind(kind), .velocity = {}});
    const std::string bytes = osi::bytes_of(before);
    const osi::Message same = osi::parse_message({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
    EXPECT_EQ(same.nanoseconds, before.nanoseconds);
    ASSERT_EQ(same.objects.size(), before.objects.size());
    for (size_t i = 0; i < same.objects.size(); ++i) EXPECT_EQ(same.objects[i].kind, before.objects[i].kind);
}

TEST(OsiMessage, WhatCannotBeIsLeftOutOrRefused) {
    const auto parsed = [](const osi::Message& message) {
        const std::string bytes = osi::bytes_of(message);
        return osi::parse_message({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    osi::Message message{.nanoseconds = 1};
    message.objects.push_back({.id = 1, .size = {-1, kNan, 1e9}, .velocity = glm::dvec3(kNan)});
    message.objects.push_back({.id = 2, .centre = {0, kNan, 0}, .velocity = {}});
    message.objects.push_back({.id = 3, .yaw = std::numeric_limits<double>::infinity(), .velocity = {}});
    message.objects.push_back({.id = 6, .pitch = 1.7e308, .velocity = {}});
    message.traffic_lights.push_back({.id = 4, .position = {kNan, 0, 0}});
    message.environment = osi::Environment{.sun_elevation = 7, .time_of_day = {}};
    const osi::Message left = parsed(message);
    ASSERT_EQ(left.objects.size(), 1u);
    EXPECT_EQ(left.objects[0].size, glm::dvec3(0));
    EXPECT_EQ(left.objects[0].velocity, std::nullopt);
    EXPECT_TRUE(left.traffic_lights.empty());
    EXPECT_EQ(left.environment->sun_elevation, std::nullopt);
    const std::vector<uint8_t> noise{0xff, 0x01, 0x02};
    EXPECT_TRUE(contains(complaint_of([&] { osi::parse_message(noise); }), "no GroundTruth or SensorView"));
    EXPECT_TRUE(contains(complaint_of([&] { osi::parse_message({}); }), "has no timestamp"));
    EXPECT_TRUE(contains(complaint_of([&] { parsed({.nanoseconds = osi::kMostNanoseconds}); }), "timestamp"));
    message.objects.assign(size_t(osi::kMostObjects) + 1, {.id = 5, .velocity = {}});
    EXPECT_TRUE(contains(complaint_of([&] { parsed(message); }), "more than 10000 objects"));
}

// Other messages have a timestamp at the same place: they are named, and are no empty GroundTruth.
TEST(OsiMessage, OtherMessagesAreNamed) {
    const auto said_of = [](const auto& message) {
        const std::string bytes = message.SerializeAsString();
        return complaint_of([&] {
            osi::parse_message({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
        });
    };
    const auto timed = [](auto message) {
        osi::wire::SensorView time;
        time.mutable_timestamp()->set_seconds(3);
        message.MergeFromString(time.SerializeAsString());
        return message;
    };
    osi::wire::SensorData measured, sensor, seen;
    measured.mutable_last_measurement_time()->set_seconds(2);
    sensor.mutable_sensor_id()->set_value(4);
    seen.add_sensor_view()->mutable_global_ground_truth()->mutable_timestamp()->set_seconds(2);
    for (const osi::wire::SensorData& data : {measured, sensor, seen})
        EXPECT_TRUE(contains(said_of(timed(data)), "is a SensorData")) << data.SerializeAsString().size();
    osi::wire::SensorView camera, hosted;
    camera.add_camera_sensor_view("x"), hosted.mutable_host_vehicle_id()->set_value(1);
    for (const osi::wire::SensorView& view : {camera, hosted})
        EXPECT_TRUE(contains(said_of(timed(view)), "is a SensorView without a global_ground_truth"));
    osi::wire::TrafficUpdate update;
    update.add_update()->mutable_base()->mutable_position()->set_x(1);
    EXPECT_TRUE(contains(said_of(timed(update)), "is a TrafficUpdate"));

    // A GroundTruth in which nothing moves, with all fields that those are told by.
    osi::wire::GroundTruth truth;
    truth.mutable_timestamp()->set_seconds(3), truth.mutable_host_vehicle_id()->set_value(1);
    truth.add_moving_object()->mutable_id()->set_value(1);
    truth.add_traffic_light()->mutable_id()->set_value(2);
    truth.add_stationary_object()->mutable_id()->set_value(3);
    const std::string bytes = truth.SerializeAsString() + "\x42\x04\x0a\x02\x08\x05" + "\x4a\x04\x0a\x02\x08\x05" +
                              "\x68\x7c";  // a road marking, a lane boundary, a country code
    const osi::Message parsed = osi::parse_message({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
    EXPECT_TRUE(parsed.objects.empty());
    EXPECT_EQ(parsed.stationary_left_out, 1u);
}

}  // namespace
}  // namespace vesper::test
