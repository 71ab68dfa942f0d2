// The bicycle model against closed forms. SPDX-License-Identifier: MIT
#include "traffic/vehicle.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace vesper::test {

using traffic::VehicleParameters, traffic::VehicleState, traffic::advance;

namespace {

constexpr double kVehicleStep = 1.0 / 60;

// A car without resistances, so that what is left is in the formulas.
VehicleParameters frictionless() {
    VehicleParameters p;
    p.rolling = 0, p.drag_area = 0;
    return p;
}

// Drives with a fixed steering angle and a held speed until nothing changes.
VehicleState settled(const VehicleParameters& p, double speed, double angle) {
    VehicleState s;
    s.speed = speed;
    for (int i = 0; i < 1200; ++i) {
        advance(s, p, {.angle = angle}, kVehicleStep);
        s.speed = speed;
    }
    return s;
}

// Rajamani 3.3: r = v delta / (L + K v^2). 1 %: the speed is put right only once a step, and tan differs from its
// angle.
TEST(Vehicle, SteadyYawGainIsTheClosedForm) {
    VehicleParameters p = frictionless();
    for (const double rear : {160000.0, 220000.0}) {
        p.rear_stiffness = rear;
        for (const double speed : {8.0, 15.0, 25.0}) {
            const double angle = 0.004;
            EXPECT_NEAR(settled(p, speed, angle).yaw_rate / angle / traffic::steady_yaw_gain(p, speed), 1, 0.01)
                << speed << " m/s";
        }
    }
}

// The angle for a radius: L / R + K v^2 / R. K is what the angle grows with lateral acceleration.
TEST(Vehicle, UndersteerGradientIsWhatTheAngleGrowsWith) {
    VehicleParameters p = frictionless();
    p.rear_stiffness = 240000;
    const double angle = 0.005, slow = 10, fast = 20;
    const auto curvature = [&](double speed) { return settled(p, speed, angle).yaw_rate / speed; };
    const double a = curvature(slow), b = curvature(fast);
    // angle = L a + K slow^2 a = L b + K fast^2 b
    const double k = (angle / b - angle / a) / (fast * fast - slow * slow);
    EXPECT_NEAR(k / traffic::understeer_gradient(p), 1, 0.02);
}

TEST(Vehicle, BrakesWithinTheFormula) {
    const VehicleParameters p = frictionless();
    for (const double pedal : {0.3, 1.0}) {
        VehicleState s;
        s.speed = 20;
        while (s.speed > 0) advance(s, p, {.brake = pedal}, kVehicleStep);
        const double expected = 20.0 * 20 / (2 * pedal * p.brake_deceleration);
        EXPECT_NEAR(s.odometer, expected, 0.1 + 20 * kVehicleStep / 4) << pedal;  // a substep at 20 m/s is 0.08 m
    }
    VehicleParameters ice = p;
    ice.friction = 0.1;
    VehicleState s;
    s.speed = 10;
    while (s.speed > 0) advance(s, ice, {.brake = 1}, kVehicleStep);
    EXPECT_NEAR(s.odometer, 100 / (2 * 0.1 * 9.80665), 0.3);
}

// Both pedals: the stronger one wins, and a car that stands does not tremble.
TEST(Vehicle, BrakesHoldAgainstTheEngine) {
    const VehicleParameters p;
    const double fades = p.drive_force / (p.mass * p.brake_deceleration);  // of the pedal
    for (const double throttle : {1.0, -1.0})
        for (const double grip : {0.9, 0.1}) {
            VehicleParameters road = p;
            road.friction = grip;
            VehicleState s;
            for (int i = 0; i < 120; ++i) {
                advance(s, road, {.throttle = throttle, .brake = fades * 1.05}, kVehicleStep);
                ASSERT_EQ(s.speed, 0) << i;
            }
            EXPECT_EQ(s.odometer, 0);
        }
    VehicleState s;
    for (int i = 0; i < 60; ++i) advance(s, p, {.throttle = 1, .brake = fades * 0.5}, kVehicleStep);
    const double expected = (p.drive_force * 0.5 - p.rolling * p.mass * 9.80665) / p.mass;
    EXPECT_NEAR(s.speed, expected, 0.02);
    s.speed = 10;
    for (int i = 0; i < 240; ++i) advance(s, p, {.throttle = 1, .brake = 1}, kVehicleStep);
    EXPECT_EQ(s.speed, 0) << "comes to rest, and stays";
    s.speed = -3;  // brakes do not stop an engine that they are weaker than
    for (int i = 0; i < 120; ++i) advance(s, p, {.throttle = 1, .brake = 0.1}, kVehicleStep);
    EXPECT_GT(s.speed, 1);
}

// Terminal speed: the engine's power is what air and tyres take.
TEST(Vehicle, TopSpeedIsWherePowerIsSpent) {
    const VehicleParameters p;
    VehicleState s;
    for (int i = 0; i < 60 * 300; ++i) advance(s, p, {.throttle = 1}, kVehicleStep);
    const double v = s.speed, spent = v * (p.rolling * p.mass * 9.80665 + 0.5 * p.air_density * p.drag_area * v * v);
    EXPECT_NEAR(spent / p.power, 1, 1e-3);
}

TEST(Vehicle, LeansOutwardsAndDives) {
    const VehicleParameters p;
    VehicleState s = settled(p, 10, 0.1);
    EXPECT_GT(s.yaw_rate, 0);
    EXPECT_GT(s.roll, 0.01);  // left turn: left side up
    s = {};
    s.speed = 20;
    for (int i = 0; i < 30; ++i) advance(s, p, {.brake = 0.8}, kVehicleStep);
    EXPECT_LT(s.pitch, -0.02);
}

// Whatever the wheel does at whatever speed: without throttle no step adds energy, and nothing blows up.
TEST(Vehicle, EnergyNeverGrowsWithoutThrottle) {
    const VehicleParameters p;
    unsigned seed = 1;
    const auto random = [&] { return double((seed = seed * 1664525u + 1013904223u) >> 8) / double(1 << 24); };
    for (int run = 0; run < 200; ++run) {
        VehicleState s;
        s.speed = 40 * random() - 3, s.lateral = 6 * random() - 3, s.yaw_rate = 4 * random() - 2;
        double energy = traffic::kinetic_energy(s, p);
        for (int i = 0; i < 120; ++i) {
            advance(s, p, {.angle = 2 * random() - 1, .brake = i % 3 ? 0 : random()}, kVehicleStep);
            const double now = traffic::kinetic_energy(s, p);
            ASSERT_LE(now, energy * (1 + 1e-12)) << "run " << run << " step " << i;
            ASSERT_TRUE(std::isfinite(s.position.x + s.yaw));
            energy = now;
        }
    }
}

// Creeping in a circle: the rear axle follows the geometry, to the centimetre.
TEST(Vehicle, SlowCarsRollWithoutSlip) {
    const VehicleParameters p = frictionless();
    VehicleState s;
    s.speed = 1, s.angle = 0.4;
    const double radius = p.wheelbase() / std::tan(0.4);
    s.yaw_rate = s.speed / radius, s.lateral = p.rear_axle * s.yaw_rate;
    const auto rear = [&] { return s.position - p.rear_axle * s.forward(); };
    const glm::dvec2 centre = rear() + radius * s.left();
    for (int i = 0; i < 60 * 20; ++i) {
        advance(s, p, {.angle = 0.4}, kVehicleStep);
        ASSERT_NEAR(glm::length(rear() - centre), radius, 0.01);
    }
    EXPECT_NEAR(s.odometer, 20 * std::hypot(1, p.rear_axle / radius), 0.5);
}

TEST(Vehicle, StandsStillAndReverses) {
    const VehicleParameters p;
    VehicleState s;
    for (int i = 0; i < 60; ++i) advance(s, p, {.angle = 0.3, .brake = 1}, kVehicleStep);
    EXPECT_EQ(s.speed, 0);
    EXPECT_EQ(s.position, glm::dvec2(0));
    for (int i = 0; i < 120; ++i) advance(s, p, {.throttle = -0.3}, kVehicleStep);
    EXPECT_LT(s.speed, -1);
    EXPECT_GT(s.position.y, 1);  // +Z lies behind
}

// Through the speeds at which rolling turns into slipping nothing jumps.
TEST(Vehicle, PassesFromRollingToSlippingSmoothly) {
    const VehicleParameters p;
    VehicleState s;
    double last = 0;
    for (int i = 0; i < 60 * 6; ++i) {
        advance(s, p, {.angle = 0.1, .throttle = 0.5}, kVehicleStep);
        EXPECT_LT(std::abs(s.yaw_rate - last), 0.02) << s.speed;
        last = s.yaw_rate;
    }
    EXPECT_GT(s.speed, 8);
}

}  // namespace
}  // namespace vesper::test
