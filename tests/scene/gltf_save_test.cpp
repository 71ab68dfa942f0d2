// A scene written and read again is the same scene. SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "base/luminance.h"
#include "photometry/standard_lamps.h"
#include "scene/gltf_save.h"
#include "scene/lamp.h"
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

using scene::Scene;

Scene example() {
    Scene scene{.name = "example"};
    scene::Material road{.name = "road"};
    road.base_colour = {0.2f, 0.21f, 0.22f, 1};
    road.reflection_table = 0;
    scene::Material sign{.name = "sign"};
    sign.roughness = 0.5f, sign.metallic = 0.0f, sign.double_sided = true, sign.retroreflector = 0;
    scene::Material shop{.name = "shop"};
    shop.emission = {120, 80, 40};
    scene.materials = {road, sign, shop};
    scene.reflection_tables.push_back(photometry::find_reflection_table("R3"));
    scene.retroreflectors.push_back(photometry::retroreflective_class("RA2"));
    scene::Mesh mesh{.name = "triangle"};
    for (uint32_t m = 0; m < 3; ++m) {
        scene::Primitive primitive{.material = m};
        for (int i = 0; i < 3; ++i) {
            scene::Vertex vertex;
            vertex.position = {float(i), float(m), float(i * i)};
            vertex.normal = {0, 1, 0};
            if (m == 1) vertex.uv = {0.25f * float(i), 1}, vertex.colour = {65535, 1000, 0, 65535};
            primitive.vertices.push_back(vertex);
            primitive.bounds.add(vertex.position);
        }
        primitive.indices = {0, 1, 2};
        mesh.primitives.push_back(primitive);
    }
    scene.meshes.push_back(mesh);
    scene::Lamp measured{.name = "street lamp",
                         .kind = scene::Lamp::Kind::Measured,
                         .intensity = 0.8f,
                         .colour = glm::vec3(1),
                         .distribution = 0};
    measured.opening.length = 0.6, measured.opening.width = 0.3;
    scene::Lamp lobe{.name = "lobe",
                     .kind = scene::Lamp::Kind::CosinePower,
                     .intensity = 300,
                     .inner_cone = 0,
                     .outer_cone = 1.2f,
                     .exponent = 8};
    scene::Lamp spot{
        .name = "spot", .kind = scene::Lamp::Kind::Spot, .intensity = 200, .inner_cone = 0.1f, .outer_cone = 0.6f};
    spot.colour = glm::vec3(glm::dvec3(2, 0.7, 0.5) / luminance(glm::dvec3(2, 0.7, 0.5)));
    spot.opening.length = spot.opening.width = 0.2, spot.opening.round = true;
    scene.lamps = {measured,
                   lobe,
                   spot,
                   {.name = "dusk", .kind = scene::Lamp::Kind::Directional, .intensity = 3, .angular_diameter = 0.07f}};
    scene.distributions.push_back(photometry::standard_lamp("street-lamp"));
    scene.cameras.push_back({.name = "eye", .vertical_fov = 0.7f, .near = 0.2f});
    scene::Node root{.name = "root"}, car{.name = "car", .parent = 0}, lamp{.name = "lamp", .parent = 1},
        second{.name = "second"};
    root.mesh = 0;
    car.translation = {1, 2, 3}, car.camera = 0;
    lamp.rotation = glm::angleAxis(0.5f, glm::vec3(0, 1, 0)), lamp.lamp = 0;
    lamp.fixture = 0, second.fixture = scene::kNone;
    second.lamp = 2, second.scale = {2, 2, 2};
    scene::Node third{.name = "third"};
    third.lamp = 1;
    scene::Node fourth{.name = "fourth"};
    fourth.lamp = 3;
    scene.nodes = {root, car, lamp, second, third, fourth};
    scene.channels.push_back({.node = 1,
                              .path = scene::Channel::Path::Translation,
                              .times = {0, 2},
                              .values = {{1, 2, 3, 0}, {5, 2, 3, 0}}});
    scene.channels.push_back(
        {.node = 1, .path = scene::Channel::Path::Rotation, .times = {0, 2}, .values = {{0, 0, 0, 1}, {0, 1, 0, 0}}});
    scene.ambient_illuminance = 0.3f, scene.sky_luminance = 0.02f;
    return scene;
}

const scene::Node& find(const Scene& scene, const std::string& name) {
    for (const scene::Node& node : scene.nodes)
        if (node.name == name) return node;
    throw Error("no node " + name);
}

class GltfSave : public testing::TestWithParam<const char*> {};

TEST_P(GltfSave, GivesTheSameSceneBack) {
    const TempFolder folder;
    const auto file = folder / GetParam();
    const Scene scene = example();
    scene::save_gltf(scene, "test", file);
    const scene::LoadedScene loaded = scene::read_scene(file);
    const Scene& got = loaded.scene;
    EXPECT_TRUE(loaded.notes.empty()) << loaded.notes[0];
    ASSERT_EQ(got.materials.size(), 3u);
    EXPECT_EQ(got.materials[0].base_colour, scene.materials[0].base_colour);
    EXPECT_EQ(got.materials[0].reflection_table, 0u);
    EXPECT_EQ(got.reflection_tables[0], scene.reflection_tables[0]);
    EXPECT_EQ(got.materials[1].retroreflector, 0u);
    EXPECT_EQ(got.retroreflectors[0].coefficient, scene.retroreflectors[0].coefficient);
    EXPECT_TRUE(got.materials[1].double_sided);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got.materials[2].emission[c], scene.materials[2].emission[c], 1e-4);
    ASSERT_EQ(got.meshes.size(), 1u);
    for (size_t m = 0; m < 3; ++m)
        for (size_t i = 0; i < 3; ++i) {
            const scene::Vertex &a = got.meshes[0].primitives[m].vertices[i],
                                &b = scene.meshes[0].primitives[m].vertices[i];
            EXPECT_EQ(a.position, b.position);
            EXPECT_EQ(a.normal, b.normal);
            EXPECT_EQ(a.uv, b.uv);
            EXPECT_EQ(a.colour, b.colour);
        }
    const auto light_on = [&](const Scene& of, const char* node) { return of.lamps[find(of, node).lamp]; };
    for (const char* node : {"lamp", "second", "third", "fourth"}) {
        const scene::Lamp a = light_on(got, node), b = light_on(scene, node);
        EXPECT_EQ(a.kind, b.kind);
        EXPECT_NEAR(a.intensity, b.intensity, 1e-4 * b.intensity);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.colour[c], b.colour[c], 1e-5);
        EXPECT_EQ(a.opening.length, b.opening.length);
        EXPECT_EQ(a.opening.width, b.opening.width);
        EXPECT_EQ(a.opening.round, b.opening.round);
        EXPECT_NEAR(a.angular_diameter, b.angular_diameter, 1e-7);
        for (const glm::dvec3 direction : {glm::dvec3(0.1, 0.2, -1), glm::dvec3(0.7, 0.1, -0.5)})
            EXPECT_NEAR(scene::luminous_intensity(a, got.distributions, direction),
                        scene::luminous_intensity(b, scene.distributions, direction), 1e-3 * b.intensity + 0.01);
    }
    EXPECT_EQ(&got.nodes.at(find(got, "lamp").fixture.value()), &find(got, "root"));
    EXPECT_EQ(find(got, "second").fixture, scene::kNone);
    EXPECT_FALSE(find(got, "third").fixture);
    const auto placed = [&](const Scene& of, const char* node, double time) {
        return scene::world_transforms(of, time)[static_cast<size_t>(&find(of, node) - of.nodes.data())];
    };
    for (const double time : {0.0, 1.0, 2.0})
        for (const char* node : {"car", "lamp", "second"}) {
            const glm::mat4 a = placed(got, node, time), b = placed(scene, node, time);
            for (int c = 0; c < 4; ++c)
                for (int r = 0; r < 4; ++r) EXPECT_NEAR(a[c][r], b[c][r], 1e-5);
        }
    EXPECT_EQ(got.cameras[0].name, "eye");
    EXPECT_EQ(got.cameras[0].vertical_fov, 0.7f);
    EXPECT_EQ(got.ambient_illuminance, 0.3f);
    EXPECT_EQ(got.sky_luminance, 0.02f);
}

INSTANTIATE_TEST_SUITE_P(Formats, GltfSave, testing::Values("scene.gltf", "scene.glb"));

TEST(GltfSaveMaterials, GlassStaysGlass) {
    const TempFolder folder;
    Scene scene;
    for (int i = 0; i < 4; ++i) {
        scene::Material& material = scene.materials.emplace_back();
        material.base_colour.a = 0.3f;  // below the cutoff of glTF, which glass that is opaque does not have
        material.clear = i % 2 == 1;
        if (i >= 2) material.alpha = scene::Material::Alpha::Mask, material.alpha_cutoff = 0.25f;
    }
    scene::save_gltf(scene, "test", folder / "scene.gltf");
    const Scene got = scene::read_scene(folder / "scene.gltf").scene;
    ASSERT_EQ(got.materials.size(), 4u);
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(got.materials[i].clear, scene.materials[i].clear) << i;
        EXPECT_EQ(got.materials[i].alpha, scene.materials[i].alpha) << i;
        EXPECT_EQ(got.materials[i].alpha_cutoff, scene.materials[i].alpha_cutoff) << i;
    }
}

TEST(GltfSaveNames, MayBeMissingOrNoUtf8) {
    const TempFolder folder;
    Scene scene;
    for (const char* name : {"scene.gltf", "scene.glb"}) {
        scene::save_gltf(scene, "test", folder / name);
        EXPECT_TRUE(scene::read_scene(folder / name).scene.nodes.empty());
    }
    scene.nodes.resize(2);
    scene.nodes[1].name = "M\xfcller";
    scene::save_gltf(scene, "K\xf6ln.xodr", folder / "scene.gltf");
    const Scene got = scene::read_scene(folder / "scene.gltf").scene;
    ASSERT_EQ(got.nodes.size(), 2u);
    EXPECT_EQ(got.nodes[0].name, "");
    EXPECT_EQ(got.nodes[0].scale, glm::vec3(1));
    EXPECT_EQ(got.nodes[1].name, "M\xef\xbf\xbdller");  // the replacement character
}

TEST(GltfSaveErrors, RefusesWhatItCannotHold) {
    const TempFolder folder;
    Scene scene = example();
    EXPECT_THROW(scene::save_gltf(scene, "test", folder / "scene.obj"), Error);
    scene.images.emplace_back();
    EXPECT_THROW(scene::save_gltf(scene, "test", folder / "scene.gltf"), Error);
    EXPECT_FALSE(std::filesystem::exists(folder / "scene.gltf"));
}

}  // namespace
}  // namespace vesper::test
