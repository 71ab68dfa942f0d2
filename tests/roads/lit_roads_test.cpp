// Scenes of road networks: where their surfaces, paint and lamps are. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "base/error.h"
#include "roads/ground.h"
#include "roads/lit_roads.h"
#include "roads/opendrive.h"
#include "roads/road_texts.h"
#include "roads/scene_parts.h"
#include "scene/lamp.h"
#include "support/shared_data.h"

namespace vesper::test {

using roads::LitRoads, roads::lit_roads;

namespace {

roads::RoadNetwork straight(const std::string& rest = "", double length = 90,
                            const std::string& lanes = two_way_section()) {
    return network_of(road("1", length, geometry(0, 0, 0, 0, length, "<line/>"), lanes, rest));
}

/// What holds of every scene: finite, unit normals on the side that is seen, indices that exist.
void expect_sound(const LitRoads& lit) {
    const scene::Scene& scene = lit.scene;
    size_t flipped = 0, count = 0;
    for (const Triangle& triangle : triangles_of(scene, "")) {
        const glm::dvec3 across = triangle.across();
        for (size_t c = 0; c < 3; ++c) {
            ASSERT_TRUE(std::isfinite(triangle.corners[c].x + triangle.corners[c].y + triangle.corners[c].z));
            ASSERT_NEAR(glm::length(triangle.normals[c]), 1, 1e-4);
            flipped += glm::dot(glm::normalize(across), triangle.normals[c]) < 0;
        }
        ++count;
    }
    EXPECT_GT(count, 10u);
    EXPECT_EQ(flipped, 0u);
    EXPECT_LE(scene.retroreflectors.size(), scene::kMaxRetroreflectors);
    for (const char* material : {"asphalt", "asphalt shoulder", "marking white", "grass"})
        for (const Triangle& triangle : triangles_of(scene, material))
            if (std::abs(glm::normalize(triangle.across()).y) > 0.05 || material != std::string("grass")) {
                EXPECT_GT(triangle.across().y, 0) << material;
            }
}

TEST(LitRoads, SurfacesHaveTheAreaOfTheirLanes) {
    const LitRoads lit = lit_roads(straight());
    expect_sound(lit);
    EXPECT_NEAR(area_of(triangles_of(lit.scene, "asphalt")), 90 * 7, 0.01);
    // The pavements' first 0.15 m are kerb stones.
    EXPECT_NEAR(area_of(triangles_of(lit.scene, "pavement")), 90 * 2 * (2 - 0.15), 0.01);
    // Kerb stones, the faces below them and the outer sides of the pavements.
    double faces = 0;
    for (const Triangle& triangle : triangles_of(lit.scene, "kerb")) {
        if (std::abs(triangle.across().y) > 1e-6) continue;
        const double z = triangle.corners[0].z;
        if (std::abs(z) > 3.6) continue;
        faces += glm::length(triangle.across()) / 2;
        EXPECT_LT(triangle.across().z * z, 0) << "looks to the road";
        EXPECT_NEAR(std::abs(z), 3.5, 1e-5);
    }
    EXPECT_NEAR(faces, 2 * 90 * 0.12, 0.001);
    EXPECT_EQ(lit.scene.reflection_tables.at(0).name, "R3");
}

TEST(LitRoads, PaintHasTheAreaOfItsDashes) {
    const std::string lanes =
        "<laneSection s=\"0\"><center><lane id=\"0\"><roadMark sOffset=\"0\" type=\"broken\" width=\"0.12\"><type "
        "name=\"broken\"><line length=\"3\" space=\"6\" sOffset=\"1\"/></type></roadMark></lane>"
        "</center><right>" +
        lane(-1, 3.5, "driving", "<roadMark sOffset=\"10\" type=\"solid\" width=\"0.2\"/>") + "</right></laneSection>";
    const LitRoads lit = lit_roads(straight("", 90, lanes));
    expect_sound(lit);
    EXPECT_NEAR(area_of(triangles_of(lit.scene, "marking white")), 10 * 3 * 0.12 + 80 * 0.2, 1e-3);
    for (const Triangle& triangle : triangles_of(lit.scene, "marking white"))
        for (const glm::dvec3& corner : triangle.corners) EXPECT_NEAR(corner.y, 0.006, 1e-6);
    const uint32_t retro = [&] {
        for (const scene::Material& material : lit.scene.materials)
            if (material.name == "marking white") return material.retroreflector;
        return scene::kNone;
    }();
    ASSERT_NE(retro, scene::kNone);
    EXPECT_TRUE(lit.scene.retroreflectors[retro].marking);
}

// Chords of the outer borders of an arc of 50 m: the sagitta of each stays within the bound.
TEST(LitRoads, SurfacesKeepToTheChord) {
    roads::LitRoadOptions options;
    for (const double chord : {0.05, 0.01}) {
        options.chord = chord;
        const LitRoads lit = lit_roads(
            network_of(road("1", 100, geometry(0, 0, 0, 0, 100, "<arc curvature=\"0.02\"/>"), two_way_section())),
            options);
        expect_sound(lit);
        double longest = 0;
        for (const Triangle& triangle : triangles_of(lit.scene, "pavement"))
            for (size_t c = 0; c < 3; ++c) {
                const auto radius = [](glm::dvec3 p) { return std::hypot(p.x, p.z + 50); };
                const glm::dvec3 a = triangle.corners[c], b = triangle.corners[(c + 1) % 3];
                if (std::abs(radius(a) - 55.5) > 1e-3 || std::abs(radius(b) - 55.5) > 1e-3) continue;
                const double sagitta = 55.5 - radius((a + b) / 2.0);
                EXPECT_LE(sagitta, chord * 1.01);
                longest = std::max(longest, sagitta);
            }
        EXPECT_GT(longest, chord / 20) << "and no finer than that needs";
    }
}

TEST(LitRoads, StreetLampsStandEverySoMuchAndLightTheRoad) {
    roads::LitRoadOptions options;
    options.lamps = {.spacing = 30, .height = 9, .side = roads::LampSide::Both, .overhang = 1};
    options.headlamps = false;
    const LitRoads lit = lit_roads(straight(), options);
    const auto lamps = lamps_of(lit.scene, "street_lamp_");
    ASSERT_EQ(lamps.size(), 6u);
    for (const scene::Node& node : lamps) {
        const scene::Lamp& lamp = lit.scene.lamps[node.lamp];
        EXPECT_NEAR(std::fmod(node.translation.x, 30), 15, 1e-3);
        EXPECT_NEAR(std::abs(node.translation.z), 3.5 + 0.7 - 1, 1e-4) << "behind the kerb, over the road";
        EXPECT_NEAR(node.translation.y, 9, 0.35);
        const glm::dvec3 down = node.rotation * glm::vec3(0, 0, -1);
        EXPECT_NEAR(down.y, -1, 1e-6);
        // To the road and along it, more than to the other side.
        const auto towards = [&](glm::dvec3 world) {
            return scene::luminous_intensity(lamp, lit.scene.distributions,
                                             glm::dvec3(glm::inverse(node.rotation) * glm::vec3(world)));
        };
        const double road_side = node.translation.z > 0 ? -1 : 1;
        EXPECT_GT(towards({0.5, -1, road_side}), 1.5 * towards({0.5, -1, -road_side}));
        EXPECT_GT(towards({1.8, -1, 0.3 * road_side}), 1000);
        EXPECT_EQ(towards({0, 1, 0}), 0);
        EXPECT_GT(lamp.opening.area(), 0);
    }
    options.lamps.spacing = 0;
    EXPECT_TRUE(lamps_of(lit_roads(straight(), options).scene, "street_lamp_").empty());
    options.lamps.spacing = 1;
    EXPECT_THROW(lit_roads(straight(), options), Error);
}

TEST(LitRoads, TheDriverFollowsTheLaneAtTheLimit) {
    const LitRoads lit =
        lit_roads(straight("<type s=\"0\" type=\"town\"><speed max=\"36\" unit=\"km/h\"/></type>", 100));
    const scene::Scene& scene = lit.scene;
    uint32_t driver = scene::kNone;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].name == "driver") driver = i;
    ASSERT_NE(driver, scene::kNone);
    EXPECT_EQ(scene.cameras[scene.nodes[driver].camera].name, "driver");
    const auto at = [&](double seconds) { return scene::world_transforms(scene, seconds)[driver]; };
    EXPECT_NEAR(at(0)[3].y, 1.2, 1e-5);
    EXPECT_NEAR(std::abs(at(0)[3].z), 1.75 - 0.37, 1e-5) << "left of the lane's middle";
    EXPECT_NEAR(std::abs(at(5)[3].x - at(1)[3].x), 40, 0.05);
    EXPECT_NEAR(scene::animation_length(scene), 10, 0.3);
    EXPECT_NEAR(std::abs(at(5)[2].x), 1, 1e-5) << "looks along the road";
    EXPECT_GT((at(5)[3].x - at(1)[3].x) * -at(5)[2].x, 0);
    EXPECT_EQ(lamps_of(scene, "car_ego/headlamp_").size(), 2u);
}

// 100 km/h, from s = 400 on 30 km/h: who drives there is as slow where that begins, and brakes no harder than
// comfortably.
TEST(LitRoads, TheDriverSlowsDownForALowerLimit) {
    const scene::Scene scene =
        lit_roads(straight("<type s=\"0\" type=\"rural\"><speed max=\"100\" unit=\"km/h\"/></type><type s=\"400\" "
                           "type=\"town\"><speed max=\"30\" unit=\"km/h\"/></type>",
                           600, "<laneSection s=\"0\"><right>" + lane(-1, 3.5) + "</right></laneSection>"))
            .scene;
    const auto way = std::find_if(scene.channels.begin(), scene.channels.end(), [&](const scene::Channel& channel) {
        return channel.path == scene::Channel::Path::Translation && scene.nodes[channel.node].name == "car_ego";
    });
    ASSERT_NE(way, scene.channels.end());
    double fastest = 0, before = 0;
    for (size_t i = 1; i < way->times.size(); ++i) {
        const double x = way->values[i].x, seconds = way->times[i] - way->times[i - 1],
                     speed = (x - way->values[i - 1].x) / seconds;
        fastest = std::max(fastest, speed);
        if (i > 1) {
            EXPECT_NEAR(speed, before, 1.55 * seconds + 0.01) << x;
        }
        if (x > 401) {
            EXPECT_NEAR(speed, 30 / 3.6, 0.05) << x;
        }
        before = speed;
    }
    EXPECT_NEAR(fastest, 100 / 3.6, 0.1);
}

TEST(LitRoads, GroundLiesBelowRoads) {
    // A slope of a quarter and a bank: nowhere above any point it was told of.
    roads::Ground ground({-50, -50}, {50, 50}, 3);
    const auto surface = [](double x, double y) { return glm::dvec3(x, y, 0.25 * x + 0.1 * y); };
    for (double x = -30; x <= 30; x += 1)
        for (double y = -4; y <= 4; y += 1) ground.stay_below(surface(x, y));
    ground.spread();
    for (double x = -30; x <= 30; x += 0.37)
        for (double y = -4; y <= 4; y += 0.37) EXPECT_LT(ground.height({x, y}), surface(x, y).z);
    EXPECT_LT(std::abs(ground.height({49, 49}) - ground.height({30, 4})), 20);
}

// A road that leans is no bridge over the lamps beside it.
TEST(LitRoads, LampsStandBesideRoadsThatLean) {
    const auto lamps = [](double lean) {
        const std::string profile = "<lateralProfile><superelevation s=\"0\"" + quantity("a", lean) +
                                    " b=\"0\" c=\"0\" d=\"0\"/></lateralProfile>";
        roads::LitRoadOptions options;
        options.lamps.spacing = 25;
        return lamps_of(lit_roads(straight(profile, 100), options).scene, "street_lamp_").size();
    };
    for (const double lean : {0.0, 0.7, 0.785398, 1.0, -0.785398, -1.0}) EXPECT_EQ(lamps(lean), 4u) << lean;
}

TEST(LitRoads, SignalsFaceTheirTraffic) {
    const std::string signals =
        "<signals><signal s=\"50\" t=\"-5\" id=\"7\" dynamic=\"yes\" orientation=\"+\" zOffset=\"3\" type=\"1000001\" "
        "country=\"OpenDRIVE\" height=\"0.9\" width=\"0.3\"/>"
        "<signal s=\"60\" t=\"-5\" id=\"8\" name=\"x\" dynamic=\"no\" orientation=\"+\" zOffset=\"2\" type=\"274\" "
        "country=\"de\" value=\"50\" height=\"0.6\" width=\"0.6\"/><signal s=\"60\" t=\"-5\" id=\"9\" name=\"x\" "
        "dynamic=\"no\" orientation=\"-\" zOffset=\"2\" type=\"274\" country=\"de\" value=\"30\" height=\"0.6\" "
        "width=\"0.6\"/></signals>";
    const LitRoads lit = lit_roads(straight(signals));
    expect_sound(lit);
    const auto red = lamps_of(lit.scene, "signal_7/red");
    ASSERT_EQ(red.size(), 1u);
    const glm::vec3 shines = red[0].rotation * glm::vec3(0, 0, -1);
    EXPECT_NEAR(shines.x, -1, 1e-5) << "towards who comes along +s";
    EXPECT_NEAR(red[0].translation.y, 3 + 0.75, 1e-4);
    EXPECT_NEAR(red[0].translation.z, 5, 1e-4);
    EXPECT_EQ(lit.scene.lamps[red[0].lamp].intensity, 200);
    for (const char* material : {"sign red", "sign white", "sign black"}) {
        const auto face = triangles_of(lit.scene, material);
        ASSERT_FALSE(face.empty()) << material;
        for (const Triangle& triangle : face)
            EXPECT_GT(triangle.across().x * (triangle.corners[0].x - 60), 0) << material << ": back to back";
    }
}

TEST(LitRoads, ObjectsStandWhereTheFileSays) {
    const std::string objects =
        "<objects><object id=\"1\" type=\"building\" name=\"house\" s=\"20\" t=\"15\" length=\"10\" width=\"6\" "
        "height=\"5\"/>"
        "<object id=\"2\" type=\"barrier\" name=\"rail\" s=\"0\" t=\"-6\"><repeat s=\"10\" length=\"50\" "
        "distance=\"0\" tStart=\"-6\" tEnd=\"-6\" heightStart=\"0.75\" heightEnd=\"0.75\" "
        "zOffsetStart=\"0\" zOffsetEnd=\"0\" widthStart=\"0.2\" widthEnd=\"0.2\"/></object>"
        "<object id=\"3\" type=\"crosswalk\" name=\"zebra\" s=\"70\" t=\"0\" length=\"4\" width=\"7\" "
        "height=\"3\"/></objects>";
    roads::LitRoadOptions options;
    options.lamps.spacing = 0;
    const LitRoads lit = lit_roads(straight(objects), options);
    expect_sound(lit);
    EXPECT_NEAR(area_of(triangles_of(lit.scene, "wall")), 2 * (10 + 6) * 5 + 60, 1e-3);
    EXPECT_NEAR(area_of(triangles_of(lit.scene, "galvanised steel")), 2 * (50 * 0.75 + 50 * 0.2 + 0.2 * 0.75), 1e-3);
    EXPECT_NEAR(area_of(triangles_of(lit.scene, "marking white")), 7 * 4 * 0.5, 1e-3);
}

TEST(LitRoads, TooMuchIsRefused) {
    roads::RoadNetwork network = straight();
    network.roads[0].length = 4e5;
    EXPECT_THROW(lit_roads(network), Error);
    roads::LitRoadOptions options;
    options.chord = 0;
    EXPECT_THROW(lit_roads(straight(), options), Error);
    EXPECT_THROW(lit_roads({}), Error);
}

TEST(LitRoads, OfSharedFilesAreSound) {
    const auto folder = shared_data("scenario");
    if (!is_here(folder)) GTEST_SKIP() << "no shared data";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".xodr") continue;
        SCOPED_TRACE(entry.path().string());
        std::optional<roads::RoadNetwork> network;
        try {
            network = roads::read_opendrive(entry.path());
        } catch (const Error&) {
            continue;
        }
        expect_sound(lit_roads(*network));
    }
}

}  // namespace
}  // namespace vesper::test
