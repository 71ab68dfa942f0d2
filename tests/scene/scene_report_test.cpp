// What a scene holds, and what is said to be implausible. SPDX-License-Identifier: MIT
#include "scene/scene_report.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

using scene::report_scene;

/// A flat street of 100 x 20 m at `height`, of reflectance 0.2, with one lamp of 3000 cd on a pole of 6 m.
struct Street {
    scene::Scene scene;
    Street() {
        scene.materials.push_back({.name = "asphalt", .base_colour = {0.2f, 0.2f, 0.2f, 1}});
        add_square(0, 100, 20, 0);
        add_lamp("lamp", {.kind = scene::Lamp::Kind::Point, .intensity = 3000}, {0, 6, 0});
    }
    void add_square(uint32_t material, float width, float depth, float height) {
        scene::Primitive p{.material = material};
        for (const glm::vec2 at : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
            p.vertices.push_back({.position = {at.x * width / 2, height, at.y * depth / 2}, .uv = at / 2.0f + 0.5f});
            p.bounds.add(p.vertices.back().position);
        }
        p.indices = {0, 2, 1, 0, 3, 2};
        scene::Node node{.name = "square"};
        node.mesh = static_cast<uint32_t>(scene.meshes.size());
        scene.meshes.push_back({.name = "square", .primitives = {p}});
        scene.nodes.push_back(node);
    }
    void add_lamp(const std::string& name, scene::Lamp lamp, glm::vec3 at) {
        lamp.name = name;
        scene::Node node{.name = name, .translation = at};
        node.lamp = static_cast<uint32_t>(scene.lamps.size());
        scene.lamps.push_back(lamp);
        scene.nodes.push_back(node);
    }
    bool warns(const std::string& part) const {
        for (const std::string& warning : report_scene(scene).warnings)
            if (warning.find(part) != std::string::npos) return true;
        return false;
    }
};

TEST(SceneReport, AddsUp) {
    Street street;
    street.add_lamp("lamp.001", street.scene.lamps[0], {10, 6.5f, 2});
    street.scene.cameras.push_back({.name = "driver"});
    scene::Node eye{.name = "eye"};
    eye.camera = 0;
    street.scene.nodes.push_back(eye);
    const scene::SceneReport report = report_scene(street.scene);
    EXPECT_EQ(report.triangles, 2u);
    EXPECT_NEAR(report.area, 2000, 1e-3);
    EXPECT_NEAR(report.extent.x, 100, 1e-4);
    EXPECT_NEAR(report.extent.z, 20, 1e-4);
    EXPECT_NEAR(report.mean_reflectance, 0.2, 1e-6);
    ASSERT_EQ(report.lamps.size(), 1u);  // names that differ by a number
    EXPECT_EQ(report.lamps[0].number, 2u);
    EXPECT_NEAR(report.lamps[0].lumens, 4 * std::numbers::pi * 3000, 1);
    EXPECT_NEAR(report.lumens, 8 * std::numbers::pi * 3000, 1);
    EXPECT_NEAR(report.lamps[0].lowest.value_or(0), 6, 1e-5);
    EXPECT_NEAR(report.lamps[0].highest.value_or(0), 6.5, 1e-5);
    EXPECT_EQ(report.cameras, std::vector<std::string>{"driver"});
    EXPECT_TRUE(report.warnings.empty()) << report.warnings.front();
}

// Nodes that show a mesh are added up without going through its triangles where they are only moved, turned and scaled
// evenly.
TEST(SceneReport, MeshesCountForEveryNodeThatShowsThem) {
    Street street;
    street.scene.nodes.push_back({.name = "turned",
                                  .translation = {0, 1, 0},
                                  .rotation = glm::angleAxis(0.5f, glm::vec3(0, 1, 0)),
                                  .scale = glm::vec3(0.5f),
                                  .mesh = 0});
    street.scene.nodes.push_back({.name = "drawn out", .translation = {0, 2, 40}, .scale = {1, 1, 3}, .mesh = 0});
    street.scene.nodes.push_back({.name = "far", .translation = {200, 0, 0}, .mesh = 0});
    street.add_lamp("over far", street.scene.lamps[0], {200, 7, 0});
    street.add_lamp("over drawn out", street.scene.lamps[0], {10, 7, 40});
    street.scene.nodes.push_back({.name = "inside", .translation = {199, 3, 0}, .scale = glm::vec3(0.25f), .mesh = 0});
    const scene::SceneReport report = report_scene(street.scene);
    EXPECT_EQ(report.triangles, 10u);
    EXPECT_NEAR(report.area, 2000 * (1 + 0.25 + 3 + 1 + 0.0625), 0.01);
    EXPECT_NEAR(report.extent.x, 300, 1e-3);
    EXPECT_NEAR(report.extent.y, 3, 1e-5);
    EXPECT_NEAR(report.extent.z, 70 + 25 * std::sin(0.5) + 5 * std::cos(0.5), 1e-3);
    ASSERT_EQ(report.lamps.size(), 3u);
    EXPECT_NEAR(report.lamps[0].lowest.value_or(0), 6, 1e-5);
    EXPECT_NEAR(report.lamps[1].lowest.value_or(0), 7, 1e-5);
    EXPECT_NEAR(report.lamps[2].lowest.value_or(0), 5, 1e-5);
}

TEST(SceneReport, MeasuredLampsAreTheirDistribution) {
    Street street;
    photometry::Distribution d{.name = "sphere", .horizontal = {0}, .vertical = {0, 180}, .candela = {50, 50}};
    street.scene.distributions.push_back(d);
    scene::Lamp lamp{.kind = scene::Lamp::Kind::Measured, .intensity = 2};
    lamp.distribution = 0;
    street.add_lamp("measured", lamp, {5, 5, 0});
    const scene::SceneReport report = report_scene(street.scene);
    ASSERT_EQ(report.lamps.size(), 2u);
    EXPECT_NEAR(report.lamps[1].candela, 100, 1e-9);
    EXPECT_NEAR(report.lamps[1].lumens, 400 * std::numbers::pi, 1e-6);
}

TEST(SceneReport, ReflectanceOfATextureIsThroughItsTransfer) {
    Street street;
    street.scene.images.push_back(
        {.name = "half", .width = 2, .height = 1, .rgba = {128, 128, 128, 255, 0, 0, 0, 255}});
    street.scene.materials[0].base_colour_texture.image = 0;
    street.scene.materials[0].base_colour = {0.5f, 0.5f, 0.5f, 1};
    street.scene.transfer = {scene::Transfer::Kind::Gamma, 2.2f};
    EXPECT_NEAR(report_scene(street.scene).materials.at(0).reflectance, 0.25 * std::pow(128 / 255.0, 2.2), 1e-6);
    street.scene.transfer = {scene::Transfer::Kind::Srgb};
    EXPECT_NEAR(report_scene(street.scene).materials.at(0).reflectance, 0.25 * 0.21586, 1e-4);
}

// Of vertex colours the mean by area, of a texture what is used.
TEST(SceneReport, ReflectanceIsThatOfTheSurfaceShown) {
    Street street;
    std::vector<scene::Vertex>& vertices = street.scene.meshes[0].primitives[0].vertices;
    for (scene::Vertex& vertex : vertices) vertex.colour = {16384, 16384, 16384, 65535};
    EXPECT_NEAR(report_scene(street.scene).mean_reflectance, 0.05, 1e-5);
    street.add_square(0, 100, 60, -1);  // three times as large, and white
    EXPECT_NEAR(report_scene(street.scene).materials.at(0).reflectance, 0.2 * (0.25 + 3) / 4, 1e-5);
    street.scene.nodes.back().scale = glm::vec3(0.5f);
    EXPECT_NEAR(report_scene(street.scene).materials.at(0).reflectance, 0.2 * (0.25 + 0.75) / 1.75, 1e-5);

    Street atlas;
    atlas.scene.images.push_back({.name = "atlas",
                                  .width = 4,
                                  .height = 1,
                                  .rgba = {255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255}});
    scene::Material& m = atlas.scene.materials[0];
    m.base_colour = glm::vec4(1), m.base_colour_texture.image = 0;
    const auto mean = [&](float low, float high) {
        auto& corners = atlas.scene.meshes[0].primitives[0].vertices;
        for (size_t i = 0; i < 4; ++i) corners[i].uv = {i % 2 ? high : low, 0.5f};
        return report_scene(atlas.scene).materials.at(0).reflectance;
    };
    EXPECT_NEAR(mean(0.1f, 0.1f), 1, 1e-6);  // a point
    EXPECT_NEAR(mean(0.55f, 0.9f), 0, 1e-6);
    EXPECT_NEAR(mean(0.375f, 0.75f), 1 / 3.0, 1e-6);  // parts of texels
    EXPECT_NEAR(mean(-0.5f, 0.5f), 0.5, 1e-6);        // the whole axis
    EXPECT_NEAR(mean(1.75f, 2.125f), 1 / 3.0, 1e-6);  // around the end: half a texel of white, one of black
    m.base_colour_texture.wrap_u = scene::Wrap::Mirror;
    EXPECT_NEAR(mean(1.25f, 1.5f), 0, 1e-6);  // an odd tile, the other way round
    EXPECT_NEAR(mean(-0.25f, -0.125f), 1, 1e-6);
    m.base_colour_texture.wrap_u = scene::Wrap::Clamp;
    EXPECT_NEAR(mean(1.25f, 1.5f), 0, 1e-6);
    EXPECT_NEAR(mean(-7.5f, -7.25f), 1, 1e-6);
}

TEST(SceneReport, WhatIsEmittedIsThroughItsTexture) {
    Street street;
    street.scene.images.push_back(
        {.name = "pane", .width = 2, .height = 1, .rgba = {128, 128, 128, 255, 0, 0, 0, 255}});
    street.scene.materials[0].emission = glm::vec3(100);
    street.scene.materials[0].emission_texture.image = 0;
    EXPECT_NEAR(report_scene(street.scene).materials.at(0).emission, 21.586, 1e-3);
}

TEST(SceneReport, WarnsOfLamps) {
    const auto with = [](float candela, glm::vec3 at) {
        Street street;
        street.scene.lamps[0].intensity = candela;
        street.scene.nodes[1].translation = at;
        return street;
    };
    EXPECT_TRUE(with(4, {0, 6, 0}).warns("4 cd from 6 m give 0.1111 lx"));
    EXPECT_FALSE(with(4, {0, 0.8f, 0}).warns("'lamp'"));  // a tail lamp
    EXPECT_TRUE(with(2e6f, {0, 0.8f, 0}).warns("beyond the lamps"));
    EXPECT_TRUE(with(5e5f, {0, 6, 0}).warns("a lit road has 5 to 50"));
    EXPECT_TRUE(with(100, {0, 0.05f, 0}).warns("stands 0.05 m above"));
    EXPECT_TRUE(with(3000, {0, -2, 0}).warns("1 of 1 below the ground"));
    EXPECT_TRUE(with(3000, {0, 6, 300}).warns("1 of 1 with no surface under it"));
    Street dark;
    dark.scene.nodes[1].lamp = scene::kNone;
    EXPECT_TRUE(dark.warns("no lamps and no ambient light"));
    dark.scene.ambient_illuminance = 0.2f;
    EXPECT_TRUE(dark.warns("there are no lamps: "));
    Street sunny;
    sunny.add_lamp("sun", {.kind = scene::Lamp::Kind::Directional, .intensity = 80000}, {0, 0, 0});
    EXPECT_TRUE(sunny.warns("8e+04 lx from the sky"));
}

TEST(SceneReport, WarnsOfSurfacesAndSize) {
    Street white;
    white.scene.materials[0].base_colour = {1, 1, 1, 1};
    EXPECT_TRUE(white.warns("a mean reflectance of 1 is more"));
    EXPECT_TRUE(white.warns("the scene is white"));
    Street metal;
    metal.scene.materials[0].metallic = 1;
    EXPECT_TRUE(metal.warns("glTF's default of 1"));
    EXPECT_TRUE(metal.warns("the scene is black"));
    Street glowing;
    glowing.scene.materials[0].emission = glm::vec3(0.8f);
    EXPECT_TRUE(glowing.warns("emits 0.8 cd/m^2 or less"));
    glowing.scene.materials[0].emission = glm::vec3(100);
    EXPECT_FALSE(glowing.warns("emits"));
    glowing.scene.materials[0].emission = glm::vec3(1e9f);
    EXPECT_TRUE(glowing.warns("more than the arc"));
    Street toy;
    toy.scene.nodes[0].scale = glm::vec3(0.01f);
    EXPECT_TRUE(toy.warns("1 m long, as small as a toy"));
    toy.scene.nodes[0].scale = glm::vec3(1000);
    EXPECT_TRUE(toy.warns("1e+05 m long"));
    toy.scene.nodes[0].mesh = scene::kNone;
    EXPECT_TRUE(toy.warns("no triangles"));
}

}  // namespace
}  // namespace vesper::test
