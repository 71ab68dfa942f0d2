// A car before an obstacle: where things are, and which lamps shine. SPDX-License-Identifier: MIT
#include "approach.h"

#include <cmath>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "scene/lamp.h"
#include "support/occluders.h"

namespace vesper::test {
namespace {

using commands::Approach, commands::ApproachSettings, commands::Beam, glm::dvec3;

/// 1000 cd ahead, at H and V of 0, and nothing more than 4 degrees off.
photometry::Distribution narrow_beam() {
    return {.name = "narrow",
            .goniometry = photometry::Goniometry::TypeA,
            .horizontal = {-4, 0, 4},
            .vertical = {-4, 0, 4},
            .candela = {0, 0, 0, 0, 1000, 0, 0, 0, 0}};
}

/// A car at (10, 0, 20) that drives towards +X, with two headlamps dipped by 1 degree, a tail lamp and a camera; a box
/// 1.8 m high at (200, 0, 22), and another car with a headlamp.
scene::Scene street() {
    OccluderScene made;
    made.box({0, 0.9f, 0}, {0.25f, 0.9f, 0.25f});
    scene::Scene scene = made.scene();
    scene.nodes[0].name = "person";
    scene.nodes[0].translation = {200, 0, 22};
    scene.cameras.push_back({.name = "driver"});
    const auto add = [&](const char* name, uint32_t parent, dvec3 place, glm::quat rotation = {1, 0, 0, 0}) {
        scene::Node& node = scene.nodes.emplace_back();
        node.name = name, node.parent = parent, node.translation = place, node.rotation = rotation;
        return uint32_t(scene.nodes.size() - 1);
    };
    const auto lamp = [&](uint32_t node, float candela) {
        scene.nodes[node].lamp = uint32_t(scene.lamps.size());
        scene.lamps.push_back({.name = "lamp", .kind = scene::Lamp::Kind::Spot, .intensity = candela});
    };
    // -Z of the car to +X.
    const glm::quat ahead = glm::angleAxis(glm::radians(-90.0f), glm::vec3(0, 1, 0));
    const glm::quat dipped = glm::angleAxis(glm::radians(-1.0f), glm::vec3(1, 0, 0));
    const uint32_t car = add("car", scene::kNone, {10, 0, 20}, ahead);
    lamp(add("headlamp_left", car, {-0.6, 0.65, -2}, dipped), 500);
    lamp(add("low", add("headlamp_right", car, {0.6, 0.65, -2}, dipped), {0, 0, 0}), 500);
    lamp(add("tail", car, {0, 0.65, 2}, glm::angleAxis(glm::radians(180.0f), glm::vec3(0, 1, 0))), 5);
    scene.nodes[add("driver", car, {-0.4, 1.2, 0})].camera = 0;
    const uint32_t other = add("other", scene::kNone, {250, 0, 17});
    lamp(add("headlamp_left", other, {0, 0.6, 0}), 700);
    lamp(add("post", scene::kNone, {100, 6, 25}), 900);
    return scene;
}

uint32_t node_named(const scene::Scene& scene, const std::string& name) {
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].name == name) return i;
    return scene::kNone;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const ApproachSettings kPerson{.camera = "driver", .obstacle = "person"};

TEST(Approach, PlacesTheEyeBeforeTheObstacle) {
    const Approach approach(street(), kPerson, {{"scene", {}}});
    EXPECT_EQ(approach.headlamps(), 2u);
    EXPECT_NEAR(glm::distance(approach.forward(), dvec3(1, 0, 0)), 0, 1e-6);
    EXPECT_NEAR(approach.aside(), 2.4, 1e-5) << "the eye is at z = 20 - 0.4, right is +Z";
    const uint32_t eye = node_named(approach.scene(), "driver"), person = node_named(approach.scene(), "person");
    for (const double distance : {100.0, 37.5}) {
        const gpu_scene::SceneFrame frame = approach.at(distance, 0, true);
        EXPECT_NEAR(glm::distance(dvec3(frame.world[eye][3]), dvec3(200 - distance, 1.2, 19.6)), 0, 1e-4);
        EXPECT_NEAR(glm::distance(dvec3(frame.world[person][3]), dvec3(200, 0, 22)), 0, 1e-6);
        EXPECT_TRUE(frame.moving[eye]);
        EXPECT_FALSE(frame.moving[person]);
    }
    ApproachSettings placed = kPerson;
    placed.obstacle_place = dvec3(120, 0.1, 19.6);
    const Approach other(street(), placed, {{"scene", {}}});
    EXPECT_NEAR(other.aside(), 0, 1e-5);
    EXPECT_NEAR(other.at(20, 0, true).world[eye][3].x, 100, 1e-4);
    EXPECT_NEAR(other.at(20, 0, true).world[person][3].y, 0.1, 1e-6);
}

TEST(Approach, EachBeamShinesAloneLevelAndAhead) {
    const Approach approach(street(), kPerson, {{"scene", {}}, {"narrow", narrow_beam()}, {"again", narrow_beam()}});
    const scene::Scene& scene = approach.scene();
    const uint32_t left = node_named(scene, "headlamp_left");
    const auto candela = [&](size_t beam, dvec3 ahead) {  // from the left headlamp, of lamps there
        const gpu_scene::SceneFrame frame = approach.at(50, beam, true);
        double sum = 0;
        for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
            if (scene.nodes[i].lamp == scene::kNone) continue;
            if (glm::distance(dvec3(frame.world[i][3]), dvec3(frame.world[left][3])) > 1e-6) continue;
            const dvec3 direction = glm::inverse(glm::dmat3(frame.world[i])) * ahead;
            sum += double(frame.dimming[i]) *
                   scene::luminous_intensity(scene.lamps[scene.nodes[i].lamp], scene.distributions, direction);
        }
        return sum;
    };
    EXPECT_NEAR(candela(0, {1, -std::tan(glm::radians(1.0)), 0}), 500, 1e-3) << "as in the scene, dipped";
    for (const size_t beam : {size_t{1}, size_t{2}}) {
        EXPECT_NEAR(candela(beam, {1, 0, 0}), 1000, 1e-2);
        EXPECT_NEAR(candela(beam, {1, std::tan(glm::radians(1.0)), 0}), 750, 1);
        EXPECT_NEAR(candela(beam, {1, 0, std::tan(glm::radians(1.0))}), 750, 1);
        EXPECT_NEAR(candela(beam, {-1, 0, 0}), 0, 1e-9);
    }
    const gpu_scene::SceneFrame frame = approach.at(50, 1, true);
    EXPECT_EQ(frame.dimming[node_named(scene, "tail")], 1) << "no headlamp";
    EXPECT_EQ(frame.dimming[node_named(scene, "post")], 1);
}

// Cars have their right headlamp as the mirror image of the left one; its beam is not mirrored.
TEST(Approach, BeamsOfMirroredHeadlampsAreUpright) {
    scene::Scene mirrored = street();
    mirrored.nodes[node_named(mirrored, "headlamp_right")].scale = {-1, 1, 1};
    mirrored.nodes[node_named(mirrored, "headlamp_left")].scale = {2, 2, 2};
    const Approach approach(std::move(mirrored), kPerson, {{"narrow", narrow_beam()}});
    const gpu_scene::SceneFrame frame = approach.at(50, 0, true);
    int beams = 0;
    for (uint32_t i = 0; i < approach.scene().nodes.size(); ++i) {
        if (approach.scene().nodes[i].name != "narrow") continue;
        const glm::dmat3 lamp = scene::lamp_frame(frame.world[i]);
        EXPECT_NEAR(glm::distance(lamp[0], dvec3(0, 0, 1)), 0, 1e-6) << "right";
        EXPECT_NEAR(glm::distance(lamp[1], dvec3(0, 1, 0)), 0, 1e-6) << "up";
        ++beams;
    }
    EXPECT_EQ(beams, 2);
}

// 20 m before the eye, in the middle: both headlamps 0.65 m up, 2 m before the origin of the car.
TEST(Approach, ItsBeamLightsTheRoad) {
    const Approach approach(street(), kPerson, {{"narrow", narrow_beam()}});
    const double way = 18, degrees = glm::degrees(std::atan(0.65 / way));
    const double aside =
        glm::degrees(std::atan(0.6 / way));  // H and V of a narrow beam; V of a place beside it is less
    const double candela = 1000 * (1 - aside / 4) * (1 - degrees / 4);
    const double expected = 2 * candela * 0.65 / std::pow(way * way + 0.6 * 0.6 + 0.65 * 0.65, 1.5);
    EXPECT_GT(expected, 0.01);
    EXPECT_NEAR(approach.road_illuminance(0, 20, 0.4), expected, 1e-3 * expected);
    EXPECT_EQ(approach.road_illuminance(0, 0, 0), 0) << "behind the headlamps";
}

TEST(Approach, OncomingLampsAreOnOrOff) {
    ApproachSettings settings = kPerson;
    settings.oncoming = "other";
    settings.without = {"o*", "post"};
    const Approach approach(street(), settings, {{"scene", {}}});
    const scene::Scene& scene = approach.scene();
    const uint32_t other = node_named(scene, "other") + 1;
    EXPECT_EQ(approach.at(50, 0, true).dimming[other], 1);
    EXPECT_EQ(approach.at(50, 0, false).dimming[other], 0);
    EXPECT_EQ(approach.at(50, 0, false).dimming[node_named(scene, "headlamp_left")], 1);
    EXPECT_NE(scene.nodes[other].lamp, scene::kNone) << "oncoming, and so not left out";
    EXPECT_EQ(scene.nodes[node_named(scene, "post")].lamp, scene::kNone);
    EXPECT_NE(scene.nodes[node_named(scene, "person")].mesh, scene::kNone);
}

TEST(Approach, RefusesNamesWithoutAMatch) {
    const auto refused = [](auto&& change) {
        ApproachSettings settings = kPerson;
        change(settings);
        try {
            Approach(street(), settings, {{"scene", {}}});
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    EXPECT_EQ(refused([](ApproachSettings&) {}), "accepted");
    EXPECT_EQ(refused([](ApproachSettings& s) { s.obstacle = "nobody"; }),
              "--obstacle nobody: no node of the scene matches it");
    EXPECT_EQ(refused([](ApproachSettings& s) { s.obstacle = "headlamp_*"; }),
              "--obstacle headlamp_*: 3 nodes match, and one is wanted");
    EXPECT_EQ(refused([](ApproachSettings& s) { s.obstacle = "post"; }), "--obstacle post: it has no surfaces");
    EXPECT_EQ(refused([](ApproachSettings& s) { s.obstacle = "car"; }),
              "--obstacle car: this is the car of the camera");
    EXPECT_EQ(refused([](ApproachSettings& s) { s.oncoming = "car"; }),
              "--oncoming car: this is the car of the camera");
    EXPECT_TRUE(contains(refused([](ApproachSettings& s) { s.oncoming = "x"; }), "--oncoming x: no node"));
    EXPECT_TRUE(contains(refused([](ApproachSettings& s) { s.without = {"x"}; }), "--without x: no node"));
    EXPECT_TRUE(contains(refused([](ApproachSettings& s) { s.headlamps = "x"; }), "--headlamps x: no node"));
    EXPECT_TRUE(contains(refused([](ApproachSettings& s) { s.headlamps = "post"; }),
                         "--headlamps post: no node above the camera driver"));
    EXPECT_TRUE(contains(refused([](ApproachSettings& s) { s.camera = "x"; }), "x"));
}

}  // namespace
}  // namespace vesper::test
