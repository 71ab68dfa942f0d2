// Lanes, traffic, walkers, kerbs and daylight. SPDX-License-Identifier: MIT
#include "traffic/world.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.h"
#include "base/error.h"
#include "places.h"
#include "support/complaints.h"
#include "support/temp_folder.h"
#include "traffic/car_following.h"
#include "traffic/daylight.h"
#include "traffic/world_file.h"

namespace vesper::test {

using traffic::Course, traffic::World, traffic::daylight_illuminance;

namespace {

constexpr double kWorldStep = 1.0 / 60;

Course straight(double length, double speed = 50 / 3.6) { return {"straight", {{0, 0, 0}, {0, 0, -length}}, 3, speed}; }

Course circle(double radius, int points = 360) {
    std::vector<glm::dvec3> round;
    for (int i = 0; i < points; ++i)
        round.push_back({radius * std::cos(2 * kPi * i / points), 1, -radius * std::sin(2 * kPi * i / points)});
    return {"circle", round, 3, 20, true};
}

// The driver stands on another lane, out of the way.
std::shared_ptr<traffic::WorldDescription> one_lane(Course lane) {
    auto d = std::make_shared<traffic::WorldDescription>();
    d->lanes.push_back(std::move(lane));
    d->lanes.emplace_back("away", std::vector<glm::dvec3>{{500, 0, 0}, {500, 0, 100}}, 3, 10);
    d->driver_lane = 1;
    return d;
}

TEST(Course, AStraightOneIsItsLine) {
    const Course lane = straight(100);
    EXPECT_EQ(lane.length(), 100);
    EXPECT_EQ(lane.at(30).position, glm::dvec3(0, 0, -30));
    EXPECT_EQ(lane.at(130).position, glm::dvec3(0, 0, -130));
    const Course::Beside left = lane.beside({-2, -40});
    EXPECT_NEAR(left.s, 40, 1e-12);
    EXPECT_NEAR(left.offset, 2, 1e-12);
    EXPECT_NEAR(lane.beside({3, 10}).s, -10, 1e-12);
    EXPECT_THROW(Course("x", {{0, 0, 0}}, 3, 10), Error);
    EXPECT_THROW(Course("x", {{0, 0, 0}, {0, 5, 0}}, 3, 10), Error);
}

TEST(Course, ACircleCloses) {
    const double radius = 20;
    const Course lane = circle(radius);
    EXPECT_NEAR(lane.length(), 2 * kPi * radius, 0.01);
    for (double s = -50; s < 300; s += 7.3) {
        const Course::Place place = lane.at(s);
        const double angle = s / lane.length() * 2 * kPi;
        EXPECT_NEAR(place.position.x, radius * std::cos(angle), 0.01) << s;
        EXPECT_NEAR(std::remainder(place.yaw - angle, 2 * kPi), 0, 0.01) << s;  // it begins towards -Z, and turns left
    }
    EXPECT_NEAR(lane.ahead(lane.length() - 5, 5), 10, 1e-9);
    // Curves are taken with 2 m/s^2 across.
    EXPECT_NEAR(lane.speed_at(33), std::sqrt(Course::kCurve * radius), 0.05);
}

TEST(Course, SlowsDownBeforeACurve) {
    std::vector<glm::dvec3> points{{0, 0, 200}};
    for (int i = 0; i <= 45; ++i)
        points.push_back({-10 + 10 * std::cos(i * kPi / 90), 0, -10 * std::sin(i * kPi / 90)});
    points.push_back(points.back() + glm::dvec3(-100, 0, -100));
    const Course lane("bend", points, 3, 20);
    const double bend = std::sqrt(Course::kCurve * 10);
    EXPECT_NEAR(lane.speed_at(204), bend, 0.1);
    EXPECT_EQ(lane.speed_at(0), 20);
    for (double s = 0; s < 199; s += 1)
        EXPECT_LE(lane.speed_at(s) * lane.speed_at(s),
                  lane.speed_at(s + 1) * lane.speed_at(s + 1) + 2 * Course::kEase * 1.01 + 1e-9);
}

// 100 km/h, between 400 m and 500 m 30 km/h: braking begins before, and the end is waited for.
TEST(Course, KeepsToLimitsThatChange) {
    std::vector<glm::dvec3> points;
    std::vector<double> limits;
    for (int i = 0; i <= 70; ++i)
        points.push_back({0, 0, -10.0 * i}), limits.push_back((i >= 40 && i < 50 ? 30 : 100) / 3.6);
    const Course lane("limits", points, 3, limits);
    EXPECT_EQ(lane.speed(), 100 / 3.6);
    EXPECT_EQ(lane.speed_at(100), 100 / 3.6);
    for (const double s : {400.01, 450.0, 499.99}) EXPECT_NEAR(lane.speed_at(s), 30 / 3.6, 1e-9) << s;
    EXPECT_EQ(lane.speed_at(500.01), 100 / 3.6);
    EXPECT_NEAR(lane.speed_at(350), std::sqrt(30 / 3.6 * 30 / 3.6 + 2 * Course::kEase * 50), 1e-9);
    EXPECT_THROW(Course("x", points, 3, std::vector<double>(3, 10)), Error);
    // On a ring, what is allowed at its last point holds up to its first.
    const Course ring("ring", {{0, 0, 0}, {0, 0, -1000}, {1000, 0, -1000}, {1000, 0, 0}}, 3, {5, 50, 50, 20}, true);
    EXPECT_LE(ring.speed_at(3990), 20);
    EXPECT_EQ(ring.speed_at(500), 5);

    auto d = one_lane(lane);
    d->cars.push_back({.node = "car", .lane = 0, .s = 0, .speed = 100 / 3.6, .length = 4.5, .speed_factor = 1});
    d->driver_lane = 0, d->driver_s = 100, d->driver_speed = 100 / 3.6;
    World world(d, 1);
    double slowest = 100, hardest = 0, before = d->driver_speed;
    for (int i = 0; i < 60 * 40 && world.driver().position.y > -690; ++i) {
        world.step({.autopilot = true}, kWorldStep);
        const double s = -world.driver().position.y, v = world.driver().speed;
        hardest = std::max(hardest, (before - v) / kWorldStep), before = v;
        if (s > 400 && s < 500) {
            EXPECT_LT(v, 30 / 3.6 * 1.05) << s;
        }
        slowest = std::min(slowest, v);
        for (const traffic::Actor& actor : world.actors())
            if (actor.node == "car" && actor.position.z < -400 && actor.position.z > -500) {
                EXPECT_LT(actor.speed, 30 / 3.6 * 1.05) << actor.position.z;
            }
    }
    EXPECT_GT(slowest, 30 / 3.6 * 0.85);
    EXPECT_LT(hardest, 2 * Course::kEase);
    EXPECT_GT(before, 40 / 3.6) << "faster again";
}

// Treiber, Hennecke and Helbing 2000: a free car accelerates with a, one at its gap of equilibrium keeps its speed.
TEST(CarFollowing, IsTheIntelligentDriverModel) {
    const traffic::CarFollowing p;
    EXPECT_EQ(traffic::idm_acceleration(p, 0, INFINITY, 0), p.acceleration);
    EXPECT_NEAR(traffic::idm_acceleration(p, p.speed, INFINITY, 0), 0, 1e-12);
    const double v = 8, gap = (p.distance + v * p.headway) / std::sqrt(1 - std::pow(v / p.speed, 4));
    EXPECT_NEAR(traffic::idm_acceleration(p, v, gap, 0), 0, 1e-12);
    EXPECT_LT(traffic::idm_acceleration(p, v, gap, 2), -0.5);
    EXPECT_EQ(traffic::idm_acceleration(p, 15, 0.01, 15), -p.hardest);
}

TEST(World, CarsNeverMeetAndKeepTheirDistance) {
    auto d = one_lane(circle(60));
    for (int i = 0; i < 12; ++i) d->cars.push_back({.node = "car", .s = 28.0 * i, .speed = 5.0 + i % 3, .length = 4.5});
    World world(d, 7);
    for (int i = 0; i < 60 * 120; ++i) {
        world.step({}, kWorldStep);
        const auto actors = world.actors();
        for (size_t a = 1; a < actors.size(); ++a)
            for (size_t b = 1; b < a; ++b) ASSERT_GT(glm::distance(actors[a].position, actors[b].position), 4.5) << i;
    }
    for (const traffic::Actor& actor : world.actors())
        if (!actor.node.empty()) {
            EXPECT_GT(actor.speed, 3);
        }
}

TEST(World, ACarStopsBehindTheDriverWithBrakeLamps) {
    auto d = one_lane(straight(1000));
    d->driver_lane = 0, d->driver_s = 100;
    d->cars.push_back({.node = "car", .s = 20, .speed = 13});
    World world(d, 1);
    bool braked = false;
    for (int i = 0; i < 60 * 30; ++i) world.step({.brake = 1}, kWorldStep), braked |= world.actors()[1].lamps.brake;
    const double gap = world.actors()[1].position.z - world.actors()[0].position.z;
    EXPECT_TRUE(braked);
    EXPECT_LT(world.actors()[1].speed, 0.2);
    EXPECT_NEAR(gap - 4.4, traffic::CarFollowing{}.distance, 1.2);
}

// The lane ends, and the car comes in anew where the driver stands.
TEST(World, ACarThatComesInAnewSparesTheDriver) {
    for (const double driver : {3.0, 30.0}) {
        auto d = one_lane(straight(400));
        d->driver_lane = 0, d->driver_s = driver;
        d->autopilot.following.speed = 25;
        d->cars.push_back({.node = "car", .s = 380, .speed = 25});
        World world(d, 1);
        double least = 1e9;
        for (int i = 0; i < 60 * 40; ++i) {
            world.step({.brake = 1}, kWorldStep);
            ASSERT_EQ(world.touched(), 0) << driver << " m, step " << i;
            if (i > 60 * 5)
                least = std::min(least, double(world.actors()[1].position.z - world.actors()[0].position.z));
        }
        EXPECT_GT(least, 4.4 + 0.5) << driver;
        EXPECT_LT(least, 60) << driver;
        EXPECT_LT(world.actors()[1].speed, 0.2) << driver;
    }
}

TEST(World, TheAutopilotKeepsToItsLane) {
    auto d = one_lane(circle(30));
    d->driver_lane = 0;
    World world(d, 1);
    for (int i = 0; i < 60 * 60; ++i) {
        world.step({.autopilot = true}, kWorldStep);
        const Course::Beside beside = d->lanes[0].beside(world.driver().position);
        ASSERT_LT(beside.distance, 0.5) << i * kWorldStep << " s";
    }
    EXPECT_NEAR(world.driver().speed, std::sqrt(Course::kCurve * 30), 0.7);
}

TEST(World, IsTheSameEveryTimeAndHangsOnItsSeed) {
    auto d = one_lane(circle(60));
    d->driver_lane = 0;
    for (int i = 1; i < 6; ++i) d->cars.push_back({.node = "car", .s = 40.0 * i, .speed = 8});
    World a(d, 5), b(d, 5), c(d, 6);
    for (int i = 0; i < 600; ++i)
        a.step({.autopilot = true}, kWorldStep), b.step({.autopilot = true}, kWorldStep),
            c.step({.autopilot = true}, kWorldStep);
    EXPECT_EQ(a.driver().position, b.driver().position);
    EXPECT_EQ(a.actors()[3].position, b.actors()[3].position);
    EXPECT_NE(a.actors()[3].position, c.actors()[3].position);
}

// A slower car ahead is overtaken on the lane beside, with an indicator.
TEST(World, ChangesLaneToOvertake) {
    auto d = one_lane(straight(3000));
    d->lanes.push_back({"left", {{-3, 0, 0}, {-3, 0, -3000}}, 3, 50 / 3.6});
    d->lanes[0].left = 2, d->lanes[2].right = 0;
    d->cars.push_back({.node = "slow", .s = 60, .speed = 6, .speed_factor = 0.4});
    d->cars.push_back({.node = "fast", .s = 20, .speed = 13, .speed_factor = 1});
    World world(d, 1);
    bool left = false;
    for (int i = 0; i < 60 * 40; ++i) world.step({}, kWorldStep), left |= world.actors()[2].lamps.left;
    EXPECT_TRUE(left);
    EXPECT_LT(world.actors()[2].position.z, world.actors()[1].position.z);
    EXPECT_NEAR(world.actors()[2].position.x, -3, 1e-9);
}

TEST(World, CarsLetWalkersCrossAndWalkersWait) {
    auto d = one_lane(straight(1000));
    d->paths.emplace_back("crossing", std::vector<glm::dvec3>{{6, 0, -200}, {-6, 0, -200}}, 1, 1.3);
    d->walkers.push_back({"walker", 0, 0.1, 0});
    d->cars.push_back({.node = "car", .s = 100, .speed = 13});
    World world(d, 1);
    double nearest = 1e9;
    bool crossed = false;
    for (int i = 0; i < 60 * 60; ++i) {
        world.step({}, kWorldStep);
        const auto actors = world.actors();
        crossed |= actors[2].position.x < -5.5;
        if (std::abs(actors[2].position.x) < 2)
            nearest = std::min(nearest, glm::distance(actors[1].position, actors[2].position));
    }
    EXPECT_TRUE(crossed);
    EXPECT_GT(nearest, 3);
}

// A kerb stops what is across it, and takes energy only.
TEST(Barrier, StopsACarAndTakesEnergy) {
    const traffic::VehicleParameters p;
    const std::vector<traffic::Barrier> kerb{{.line = {{3, 50}, {3, -200}}, .height = {}}};
    for (const double yaw : {-0.05, -0.3, -1.2}) {  // to the right
        traffic::VehicleState s;
        s.yaw = yaw, s.speed = 12;
        bool hit = false;
        double energy = traffic::kinetic_energy(s, p);
        for (int i = 0; i < 60 * 4; ++i) {
            const traffic::VehicleState before = s;
            traffic::advance(s, p, {}, kWorldStep);
            hit |= traffic::collide(s, before, p, kerb);
            ASSERT_LE(traffic::kinetic_energy(s, p), energy * (1 + 1e-9));
            energy = traffic::kinetic_energy(s, p);
            for (const int ahead : {-1, 1})
                for (const int side : {-1, 1}) {
                    const glm::dvec2 corner = s.position +
                                              ((p.front_axle - p.rear_axle) / 2 + ahead * p.length / 2) * s.forward() +
                                              side * p.width / 2 * s.left();
                    ASSERT_LT(corner.x, 3.05) << yaw << " " << i;
                }
        }
        EXPECT_TRUE(hit);
    }
}

// A street under a bridge: neither its kerbs nor who stands there hold up a car above, nor is its lane that of who
// drives by hand.
TEST(World, RoadsAboveOneAnotherDoNotMeet) {
    for (const double high : {5.0, 0.0}) {
        const auto d = std::make_shared<traffic::WorldDescription>();
        d->lanes.emplace_back("above", std::vector<glm::dvec3>{{0, high, 0}, {0, high, -300}}, 3, 15);
        d->lanes.emplace_back("below", std::vector<glm::dvec3>{{-60, 0, -60}, {600, 0, -500}}, 3, 10);
        d->barriers.push_back({.line = {{-50, -104}, {50, -104}}, .height = 0.0});
        d->external_nodes = {"parked"};
        const traffic::ExternalActor parked{.actor = {.node = "", .position = {0, 0, -100}, .yaw = -kPi / 2}};
        for (const bool by_hand : {false, true}) {
            World world(d, 1);
            world.place({parked});
            for (int i = 0; i < 30 / kWorldStep; ++i)
                world.step({.throttle = by_hand ? 0.3 : 0.0, .autopilot = !by_hand}, kWorldStep);
            const glm::dvec3 at = world.actors().front().position;
            if (high > 0) {
                EXPECT_LT(at.z, -250) << by_hand;
                EXPECT_NEAR(at.y, high, 1e-9) << by_hand;
                EXPECT_TRUE(world.contacts().empty());
            } else {
                EXPECT_GT(at.z, -104) << by_hand;
            }
        }
    }
}

// Another program has the driver's car: it is where that says, and meets nobody.
TEST(World, AHostDrivesTheCar) {
    auto d = one_lane(straight(400));
    d->driver_lane = 0, d->driver_s = 10;
    d->external_nodes = {"other"};
    World world(d, 1);
    EXPECT_LT(world.actors()[1].position.y, -40) << "not there yet";
    const traffic::Actor host{.node = "", .position = {2, 0.5, -80}, .yaw = 0.1, .pitch = 0.02, .speed = 7};
    world.place({{.index = 0, .actor = {.node = "", .position = {2, 0.5, -82}}}}, host);
    world.step({.throttle = 1}, kWorldStep);
    const traffic::Actor me = world.actors().front();
    EXPECT_EQ(me.position, host.position);
    EXPECT_EQ(me.pitch, host.pitch);
    EXPECT_EQ(world.driver().speed, 7);
    EXPECT_NEAR(world.driver().position.y, -80 - 0.24 * std::cos(0.1), 1e-6) << "the centre of mass lies ahead";
    EXPECT_TRUE(world.contacts().empty());
    EXPECT_EQ(world.actors()[1].position, glm::dvec3(2, 0.5, -82));
    world.place({});
    world.step({.throttle = 1}, kWorldStep);
    EXPECT_GT(world.driver().speed, 7) << "and by itself again";
    EXPECT_LT(world.actors()[1].position.y, -40);
}

TEST(Lamps, IndicatorsFlashNinetyTimesAMinute) {
    int changes = 0;
    bool last = false;
    for (int i = 0; i < 6000; ++i) {
        const bool lit = traffic::lamps_of(traffic::Beam::Low, traffic::Indicator::Left, false, i * 0.01).left;
        changes += lit && !last, last = lit;
    }
    EXPECT_EQ(changes, 90);
    EXPECT_FALSE(traffic::lamps_of(traffic::Beam::Off, traffic::Indicator::Left, true, 0).tail);
    EXPECT_TRUE(traffic::lamps_of(traffic::Beam::High, traffic::Indicator::None, true, 0).high);
}

// Janiczek and DeYoung 1987, table: 759 lx at the horizon, 3.40 at -6, 8.3e-3 at -12 and 6.5e-4 at -18 degrees.
TEST(Daylight, IsThePublishedTwilight) {
    EXPECT_NEAR(daylight_illuminance(0), 759, 1);
    EXPECT_NEAR(daylight_illuminance(-6), 3.40, 0.05);
    EXPECT_NEAR(daylight_illuminance(-12), 8.31e-3, 0.03 * 8.31e-3 + 1e-5);  // what the cubic is off
    EXPECT_NEAR(daylight_illuminance(-18), 6.51e-4, 0.1e-4);
    EXPECT_NEAR(daylight_illuminance(90) / 1.29e5, 1, 0.01);
    EXPECT_EQ(daylight_illuminance(-60), daylight_illuminance(-18));
    for (double e = -18; e < 90; e += 0.01)
        EXPECT_LE(daylight_illuminance(e), daylight_illuminance(e + 0.01) * 1.02) << e;
}

TEST(WorldFile, TheStreetOfRivoliIsOne) {
    const traffic::WorldFile file =
        traffic::read_world(std::string(VESPER_SOURCE_DIR) + "/data/rivoli/rivoli.world.json");
    EXPECT_EQ(file.world.lanes.size(), 2u);
    EXPECT_EQ(file.world.cars.size(), 17u);
    EXPECT_EQ(file.tunnels.size(), 1u);
    EXPECT_EQ(file.scene.filename(), "rivoli-drive.gltf");
    EXPECT_TRUE(file.world.lanes[0].closed());
    EXPECT_EQ(file.world.lanes[0].right, 1);
}

// Files that would keep a drive busy for ever are refused with their place.
TEST(WorldFile, HasBounds) {
    const TempFolder folder;
    const auto refused = [&](const std::string& more) {
        folder.write(
            "w.json",
            R"({"version": 1, "scene": "s.gltf", "driver": {"lane": "a"}, "lanes": [{"name": "a", "points": [[0, 0, 0], [0, 0, -9]]}])" +
                more + "}");
        return complaint_of([&] { traffic::read_world(folder / "w.json"); });
    };
    const auto many = [](size_t count, const std::string& one) {
        std::string text = "[" + one;
        for (size_t i = 1; i < count; ++i) text += "," + one;
        return text + "]";
    };
    EXPECT_EQ(refused(R"(, "paths": [{"name": "p", "points": [[0, 0, 0], [5000, 0, 0]]}])"), "");
    EXPECT_TRUE(contains(refused(R"(, "paths": [{"name": "p", "points": [[-1000000, 0, 0], [1000000, 0, 0]]}])"),
                         "w.json: /paths: are longer than 10000 m"));
    EXPECT_TRUE(contains(refused(R"(, "cars": )" + many(1001, R"({"node": "c", "lane": "a"})")),
                         "w.json: /cars: more than 1000"));
    EXPECT_TRUE(
        contains(refused(R"(, "barriers": [)" + many(100'001, "[0, 1]") + "]"), "w.json: /barriers/0: with this one"));
}

}  // namespace
}  // namespace vesper::test
