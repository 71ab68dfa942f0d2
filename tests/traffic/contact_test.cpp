// Cars that meet cars and people. SPDX-License-Identifier: MIT
#include "traffic/contact.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.h"
#include "traffic/world.h"

namespace vesper::test {
namespace {

constexpr double kStep = 1.0 / 60;

std::shared_ptr<traffic::WorldDescription> street() {
    auto d = std::make_shared<traffic::WorldDescription>();
    d->lanes.emplace_back("straight", std::vector<glm::dvec3>{{0, 0, 0}, {0, 0, -1000}}, 3, 50 / 3.6);
    return d;
}

// An external actor that stands at z, its front to the left of who comes.
traffic::ExternalActor standing(double z, double yaw) {
    return {.index = 0, .actor = {.node = "", .position = {0, 0, z}, .yaw = yaw}, .length = 5, .width = 2};
}

TEST(GroundBox, OverlapsAreTheShortestWayOut) {
    const traffic::GroundBox a{.centre = {0, 0}, .yaw = 0, .length = 4, .width = 2};
    // Beside one another, 0.25 m in each other.
    const auto side = traffic::overlap({.centre = {1.75, 0.5}, .yaw = 0, .length = 4, .width = 2}, a);
    ASSERT_TRUE(side);
    EXPECT_NEAR(side->depth, 0.25, 1e-12);
    EXPECT_NEAR(side->normal.x, 1, 1e-12);
    EXPECT_NEAR(side->point.x, 0.875, 1e-12);
    EXPECT_NEAR(side->point.y, 0.25, 1e-12);
    EXPECT_FALSE(traffic::overlap({.centre = {2.01, 0}, .yaw = 0, .length = 4, .width = 2}, a));
    // A corner towards a side: half the diagonal of a square and half a width reach out.
    const double reach = std::sqrt(2.0) + 1;
    EXPECT_FALSE(traffic::overlap({.centre = {reach + 1e-6, 0}, .yaw = kPi / 4, .length = 2, .width = 2}, a));
    const auto corner = traffic::overlap({.centre = {reach - 0.1, 0}, .yaw = kPi / 4, .length = 2, .width = 2}, a);
    ASSERT_TRUE(corner);
    EXPECT_NEAR(corner->depth, 0.1, 1e-9);
    EXPECT_NEAR(corner->normal.x, 1, 1e-9);
    // Boxes of a circle of directions about one another: never both apart and in each other.
    for (double angle = 0; angle < 2 * kPi; angle += 0.1)
        for (double yaw = 0; yaw < kPi; yaw += 0.1) {
            const traffic::GroundBox b{
                .centre = 2.2 * glm::dvec2(std::cos(angle), std::sin(angle)), .yaw = yaw, .length = 4, .width = 2};
            const auto found = traffic::overlap(b, a);
            traffic::GroundBox out = b;
            if (found) out.centre += (found->depth + 1e-9) * found->normal;
            EXPECT_FALSE(traffic::overlap(out, a)) << angle << " " << yaw;
            bool inside = false;
            for (const glm::dvec2 c : b.corners()) inside |= a.contains(c);
            EXPECT_TRUE(found || !inside) << angle << " " << yaw;
        }
}

// Two bodies without spring go on together: m v / (m + M), whichever way they came.
TEST(Blow, KeepsMomentum) {
    const traffic::VehicleParameters p;
    for (const double heavy : {0.5, 1.0, 20.0}) {
        traffic::VehicleState s;
        s.speed = 10;
        const glm::dvec2 ahead(0, -1);
        const double mass = heavy * p.mass, theirs = 2;
        const glm::dvec2 impulse =
            traffic::strike(s, p, {0, -2}, -ahead, {.velocity = theirs * ahead, .heading = ahead, .along = 1 / mass});
        const double common = (p.mass * 10 + mass * theirs) / (p.mass + mass);
        EXPECT_NEAR(s.speed, common, 1e-9);
        EXPECT_NEAR(theirs - glm::dot(impulse, ahead) / mass, common, 1e-9);
        EXPECT_NEAR(s.yaw_rate, 0, 1e-12);
        EXPECT_EQ(glm::length(traffic::strike(s, p, {0, -2}, -ahead,
                                              {.velocity = 50.0 * ahead, .heading = ahead, .along = 1 / mass})),
                  0)
            << "they part";
    }
}

// Off the middle and aslant: no blow has more energy after than before, with the other's counted.
TEST(Blow, TakesEnergy) {
    const traffic::VehicleParameters p;
    for (double x = -0.9; x <= 0.9; x += 0.3)
        for (double angle = 0; angle < 2 * kPi; angle += 0.37) {
            traffic::VehicleState s;
            s.speed = 12, s.lateral = -1, s.yaw_rate = 0.3;
            const glm::dvec2 heading(std::cos(angle), std::sin(angle)), theirs = 4.0 * heading;
            const double mass = 1200, before = traffic::kinetic_energy(s, p) + mass * 16 / 2;
            const glm::dvec2 impulse =
                traffic::strike(s, p, {x, -2.2}, {0, 1},
                                {.velocity = theirs, .heading = heading, .along = 1 / mass, .across = 1 / mass});
            const glm::dvec2 after = theirs - impulse / mass;
            EXPECT_LE(traffic::kinetic_energy(s, p) + mass * glm::dot(after, after) / 2, before * (1 + 1e-12))
                << x << " " << angle;
        }
}

TEST(World, AParkedVanStopsTheDriver) {
    auto d = street();
    d->driver_s = 20, d->driver_speed = 14;
    d->external_nodes = {"van"};
    traffic::World world(d, 1);
    world.place({standing(-60, kPi / 2)});
    for (int i = 0; i < 60 * 6; ++i) {
        world.step({}, kStep);
        const traffic::GroundBox van{.centre = {0, -60}, .yaw = kPi / 2, .length = 5, .width = 2};
        const auto in = traffic::overlap(traffic::ground_box(world.driver(), d->vehicle), van);
        ASSERT_TRUE(!in || in->depth < 1e-6) << i;
    }
    EXPECT_LT(std::abs(world.driver().speed), 0.1);
    ASSERT_EQ(world.contacts().size(), 1u);
    EXPECT_EQ(world.contacts()[0].node, "van");
    EXPECT_NEAR(world.contacts()[0].speed, 13.5, 0.4);  // 14 m/s, less what 37 m of rolling take
    EXPECT_NEAR(world.contacts()[0].impulse / (d->vehicle.mass * world.contacts()[0].speed), 1, 1e-6);
    EXPECT_NEAR(world.contacts()[0].seconds, 37.0 / 13.8, 0.2);
}

// Into the rear of a car of equal mass: both go on with half the speed, and traffic keeps to its lane.
TEST(World, ACarThatIsHitGoesOnWithTheBlow) {
    auto d = street();
    d->driver_s = 30, d->driver_speed = 14;
    d->cars.push_back({.node = "slow", .s = 36, .speed = 2, .speed_factor = 0.1});
    traffic::World world(d, 1);
    while (world.contacts().empty() && world.seconds() < 5) world.step({}, kStep);
    ASSERT_EQ(world.contacts().size(), 1u);
    EXPECT_EQ(world.contacts()[0].node, "slow");
    EXPECT_NEAR(world.driver().speed, world.actors()[1].speed, 1e-9);
    EXPECT_NEAR(world.driver().speed, 8, 0.3);
    traffic::World same(d, 1);
    while (same.seconds() < 5) same.step({}, kStep);
    while (world.seconds() < 5) world.step({}, kStep);
    EXPECT_EQ(same.driver().position, world.driver().position) << "the same every time";
    EXPECT_GT(world.actors()[1].position.z - world.actors()[0].position.z, -100);
}

TEST(World, WhoIsHitFallsAndOthersWaitForCars) {
    auto d = street();
    d->driver_s = 20, d->driver_speed = 12;
    d->paths.emplace_back("crossing", std::vector<glm::dvec3>{{6, 0, -60}, {-6, 0, -60}}, 1, 1.3);
    d->walkers.push_back({.node = "walker", .path = 0, .wait = 0, .s = 2.5});  // in the middle after 2.7 s
    traffic::World world(d, 1);
    while (world.contacts().empty() && world.seconds() < 8) world.step({.throttle = 0.2}, kStep);
    ASSERT_EQ(world.contacts().size(), 1u);
    const double speed = world.driver().speed;
    EXPECT_EQ(world.contacts()[0].node, "walker");
    EXPECT_NEAR(speed / world.contacts()[0].speed, 1573.0 / (1573 + 75), 0.02);  // all but the mass of a person
    const glm::dvec3 where = world.actors()[1].position;
    for (int i = 0; i < 60; ++i) world.step({}, kStep);
    EXPECT_EQ(world.actors()[1].position, where);
    EXPECT_NEAR(world.actors()[1].pitch, kPi / 2, 1e-9);
    EXPECT_EQ(world.contacts().size(), 1u);

    // A car that stands on the crossing is walked up to, not into.
    d->driver_s = 60, d->driver_speed = 0;
    traffic::World blocked(d, 1);
    for (int i = 0; i < 60 * 8; ++i) blocked.step({.brake = 1}, kStep);
    EXPECT_TRUE(blocked.contacts().empty());
    EXPECT_GT(blocked.actors()[1].position.x, 0.9);
}

}  // namespace
}  // namespace vesper::test
