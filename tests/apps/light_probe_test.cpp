// Light at a pixel, against closed forms. SPDX-License-Identifier: MIT
#include "window/light_probe.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace vesper::test {
namespace {

/// A square of 20 m on the ground, and a lamp that shines down on it from 5 m.
scene::Scene ground() {
    scene::Scene scene;
    scene.materials.emplace_back();
    scene::Primitive square;
    for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1)}) {
        square.vertices.push_back({.position = {corner.x, 0, corner.y}});
        square.bounds.add(square.vertices.back().position);
    }
    square.indices = {0, 1, 2, 0, 2, 3};
    scene.meshes.push_back({"square", {square}});
    scene.lamps.push_back({.name = "lamp", .kind = scene::Lamp::Kind::Point, .intensity = 1000});
    scene.nodes.push_back({.name = "ground", .scale = glm::vec3(10, 1, 10), .mesh = 0});
    scene.nodes.push_back({.name = "lamp", .translation = {0, 5, 0}, .lamp = 0});
    return scene;
}

/// An eye 3 m above the ground that looks straight down: up in the picture is -Z.
gpu_scene::View from_above(VkExtent2D extent, glm::vec3 eye) {
    return gpu_scene::View::symmetric(extent, std::numbers::pi_v<float> / 2,
                                      glm::lookAt(eye, eye - glm::vec3(0, 1, 0), glm::vec3(0, 0, -1)));
}

TEST(LightProbe, FindsTheSurfaceBehindAPixel) {
    const scene::Scene scene = ground();
    const gpu_scene::SceneFrame frame{.world = scene::world_transforms(scene, 0)};
    const gpu_scene::View view = from_above({9, 9}, {2, 3, 1});
    const auto middle = drive::surface_at(scene, frame, view, {4, 4});
    ASSERT_TRUE(middle);
    EXPECT_NEAR(glm::length(middle->position - glm::dvec3(2, 0, 1)), 0, 1e-5);
    EXPECT_NEAR(middle->distance, 3, 1e-5);
    EXPECT_NEAR(glm::length(middle->normal - glm::dvec3(0, 1, 0)), 0, 1e-6);
    EXPECT_EQ(middle->node, 0u);
    // The picture covers 3 m to either side: a pixel is 2/3 m. Right is +X, down is +Z.
    const auto corner = drive::surface_at(scene, frame, view, {8, 0});
    ASSERT_TRUE(corner);
    EXPECT_NEAR(glm::length(corner->position - glm::dvec3(2 + 8.0 / 3, 0, 1 - 8.0 / 3)), 0, 1e-5);
    EXPECT_FALSE(drive::surface_at(scene, frame, from_above({9, 9}, {40, 3, 0}), {4, 4}));     // beside it
    EXPECT_FALSE(drive::surface_at(scene, frame, from_above({9, 9}, {0, -1, 0}), {4, 4}));     // below it
    EXPECT_FALSE(drive::surface_at(scene, frame, from_above({1, 1}, {0, 0.05f, 0}), {0, 0}));  // nearer than is drawn
}

TEST(LightProbe, SeesTheFrontOfSurfacesAndBothSidesOfDoubleSidedOnes) {
    scene::Scene scene = ground();
    for (uint32_t& i : scene.meshes[0].primitives[0].indices) i = 3 - i;  // faces down
    const gpu_scene::SceneFrame frame{.world = scene::world_transforms(scene, 0)};
    EXPECT_FALSE(drive::surface_at(scene, frame, from_above({3, 3}, {0, 3, 0}), {1, 1}));
    scene.materials[0].double_sided = true;
    const auto back = drive::surface_at(scene, frame, from_above({3, 3}, {0, 3, 0}), {1, 1});
    ASSERT_TRUE(back);
    EXPECT_GT(back->normal.y, 0.999);  // towards the eye
}

TEST(LightProbe, IlluminanceIsCandelaCosineOverDistanceSquared) {
    scene::Scene scene = ground();
    gpu_scene::SceneFrame frame{.world = scene::world_transforms(scene, 0)};
    const drive::SurfacePoint below{.position = {0, 0, 0}}, aside{.position = {5, 0, 0}},
        facing_away{.position = {0, 0, 0}, .normal = {0, -1, 0}};
    EXPECT_NEAR(drive::lamp_illuminance(scene, frame, below), 40, 1e-5);  // 1000 / 25
    EXPECT_NEAR(drive::lamp_illuminance(scene, frame, aside), 1000 / 50.0 * std::sqrt(0.5), 1e-5);
    EXPECT_EQ(drive::lamp_illuminance(scene, frame, facing_away), 0);
    frame.dimming = {1, 0.25f};
    EXPECT_NEAR(drive::lamp_illuminance(scene, frame, below), 10, 1e-5);
    // A directional light of 100 lx from 60 degrees above the horizon, dimmed not at all.
    scene.lamps.push_back({.name = "moon", .kind = scene::Lamp::Kind::Directional, .intensity = 100});
    scene.nodes.push_back(
        {.name = "moon", .rotation = glm::angleAxis(-std::numbers::pi_v<float> / 3, glm::vec3(1, 0, 0)), .lamp = 1});
    frame = {.world = scene::world_transforms(scene, 0), .dimming = {1, 0, 1}};
    EXPECT_NEAR(drive::lamp_illuminance(scene, frame, below), 100 * std::sin(std::numbers::pi / 3), 1e-3);
}

}  // namespace
}  // namespace vesper::test
