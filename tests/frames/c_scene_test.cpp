// Scenes made in memory through the C interface: light by the laws it follows, and what is added, hung on something,
// dimmed and removed. SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "photometry/distribution.h"
#include "photometry/ies.h"
#include "places.h"
#include "support/c_scene.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

// A plate between lamp and ground.
TEST_F(CScene, LampsLightWhatTheySee) {
    add(candle());
    uint32_t plate = VESPER_NONE;
    expect(vesper_scene_add_node(scene, "plate", ground_mesh, at(0, 0.75f, 0).data(), &plate, &error));
    VesperView view = down();
    const auto light = [&] { return render(view)[4 * kMiddle] * kPi; };
    EXPECT_EQ(light(), 0);
    expect(vesper_set(renderer, "shadows", 0, &error));
    EXPECT_NEAR(light(), 1, 2e-3);
    expect(vesper_unset(renderer, "shadows", &error));
    EXPECT_EQ(light(), 0);
}

// I / d^2, and sums of it; 0.2 % is what half floats of reflectance and the size of a pixel cost.
TEST_F(CScene, LampsComeAndGo) {
    EXPECT_EQ(lux(), 0);
    const uint32_t one = add(candle());
    EXPECT_NEAR(lux(), 1, 2e-3);
    VesperLamp higher = candle();
    higher.position[1] = 2, higher.intensity = 8;
    const uint32_t two = add(higher);
    EXPECT_NEAR(lux(), 3, 6e-3);
    expect(vesper_renderer_dim(renderer, two, 0.5f, &error));
    EXPECT_NEAR(lux(), 2, 4e-3);
    expect(vesper_scene_remove(scene, one, &error));
    EXPECT_NEAR(lux(), 1, 2e-3);
    expect(vesper_renderer_dim(renderer, two, 0, &error));
    EXPECT_EQ(lux(), 0);
    EXPECT_EQ(vesper_scene_node_count(scene), 3u) << "numbers stay";
}

// A car: a node with a body and a lamp on it, driven 3 m to the right; the lamp is where its own place in the car's
// frame says.
TEST_F(CScene, WhatHangsOnANodeMovesWithIt) {
    uint32_t car = 0, body = 0;
    expect(vesper_scene_add_node(scene, "car", VESPER_NONE, nullptr, &car, &error));
    expect(vesper_scene_add_node(scene, "body", ground_mesh, at(0, 5, 0).data(), &body, &error));
    const uint32_t lamp = add(candle());
    expect(vesper_scene_attach(scene, body, car, &error));
    expect(vesper_scene_attach(scene, lamp, car, &error));
    EXPECT_NEAR(lux(0), 1, 2e-3);
    expect(vesper_renderer_place(renderer, car, at(3, 0, 0).data(), &error));
    EXPECT_NEAR(lux(3), 1, 2e-3);
    EXPECT_NEAR(lux(0), 1 / std::pow(10.0f, 1.5f), 2e-4) << "cos / d^2, d^2 = 10";
    expect(vesper_scene_remove(scene, car, &error));
    EXPECT_EQ(lux(3), 0) << "with all that hangs on it";
    EXPECT_STREQ(vesper_scene_node_name(scene, body), "body");
    EXPECT_EQ(vesper_scene_attach(scene, car, body, &error), VESPER_BAD_ARGUMENT) << "the later on the earlier";
    EXPECT_EQ(vesper_scene_attach(scene, car, car, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_scene_attach(scene, 99, car, &error), VESPER_BAD_ARGUMENT);
}

// Where a node is put is exact, however far away it was, and so is what hangs on it: 1 m there, not the difference of
// large numbers.
TEST_F(CScene, NodesComeBackFromFarAway) {
    const float c = std::cos(0.5f), s = std::sin(0.5f), far = 4e6f;
    const std::vector<float> away{c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, far, 0, far, 1};
    uint32_t car = 0;
    expect(vesper_scene_add_node(scene, "car", VESPER_NONE, away.data(), &car, &error));
    const uint32_t lamp = add(candle());
    expect(vesper_scene_attach(scene, lamp, car, &error));
    EXPECT_LT(lux(), 1e-6f);
    expect(vesper_renderer_place(renderer, car, at(0, 0, 0).data(), &error));
    EXPECT_NEAR(lux(), 1, 2e-3);
}

// Directions have no length: a spot and a view with vectors whose squares no float holds.
TEST_F(CScene, DirectionsAreOfAnyLength) {
    VesperLamp spot = candle();
    spot.outer_cone = 0.5f, spot.inner_cone = 0.4f, spot.axis[1] = -1, spot.up[2] = 1;
    const uint32_t one = add(spot);
    EXPECT_NEAR(lux(), 1, 2e-3);
    for (const float length : {1e-30f, 1e30f}) {
        spot.axis[1] = -length, spot.up[2] = length;
        const uint32_t other = add(spot);
        expect(vesper_renderer_dim(renderer, one, 0, &error));
        EXPECT_NEAR(lux(), 1, 2e-3) << length;
        VesperView view = down();
        view.forward[1] *= length, view.up[2] *= length;
        EXPECT_EQ(render(view), render(down())) << length;
        expect(vesper_scene_remove(scene, other, &error));
    }
}

// A measured lamp gives what its file says towards the ground, along its axis and off it, as it is turned.
TEST_F(CScene, MeasuredLampsShineAsTheirFile) {
    const std::string file = VESPER_SOURCE_DIR "/data/photometry/street-lamp.ies";
    const photometry::Distribution distribution = photometry::read_distribution(file);
    VesperLamp lamp = candle();
    lamp.position[1] = 4, lamp.axis[1] = -1, lamp.up[2] = 1, lamp.distribution = file.c_str(), lamp.intensity = 0.5f;
    const uint32_t first = add(lamp);
    // Its frame: +y is the world's +z and -z is down, so +x is -x of the world.
    const double below = 0.5 * photometry::intensity(distribution, {0, 0, -1}),
                 aside = 0.5 * photometry::intensity(distribution, {-3, 0, -4});
    EXPECT_NEAR(lux(0), below / 16, 3e-3 * below / 16);
    EXPECT_NEAR(lux(3), aside * 0.8 / 25, 1e-2 * aside * 0.8 / 25);
    expect(vesper_scene_remove(scene, first, &error));
    lamp.up[2] = 0, lamp.up[0] = 1;
    add(lamp);
    const double turned = 0.5 * photometry::intensity(distribution, {0, 3, -4});
    EXPECT_NEAR(lux(3), turned * 0.8 / 25, 1e-2 * turned * 0.8 / 25);
    lamp.distribution = "/nothing.ies";
    uint32_t node = 0;
    EXPECT_EQ(vesper_scene_add_lamp(scene, &lamp, &node, &error), VESPER_FAILED);
    EXPECT_NE(std::string(error.message).find("/nothing.ies"), std::string::npos);
    EXPECT_NEAR(lux(3), turned * 0.8 / 25, 1e-2 * turned * 0.8 / 25) << "and nothing has changed";
}

// A file that was edited is another distribution, and the lamps that have the old one keep it.
TEST_F(CScene, ChangedLampFilesAreReadAnew) {
    const TempFolder folder;
    const auto written = [&](double candela) {
        photometry::Distribution even;
        even.goniometry = photometry::Goniometry::CGamma, even.horizontal = {0}, even.vertical = {0, 90},
        even.candela = {candela, candela};
        return folder.write("x.ies", photometry::write_ies(even)).string();
    };
    const std::string file = written(100);
    VesperLamp lamp = candle();
    lamp.axis[1] = -1, lamp.distribution = file.c_str();
    const uint32_t first = add(lamp), second = add(lamp);
    EXPECT_NEAR(lux(), 200, 0.5);
    written(5);
    add(lamp);
    EXPECT_NEAR(lux(), 205, 0.5);
    expect(vesper_scene_remove(scene, first, &error));
    expect(vesper_scene_remove(scene, second, &error));
    EXPECT_NEAR(lux(), 5, 0.02);
    std::filesystem::remove(file);
    EXPECT_EQ(vesper_scene_add_lamp(scene, &lamp, nullptr, &error), VESPER_FAILED);
}

// Normals of no direction are those of their triangles, as where there are none, and not up.
TEST_F(CScene, NormalsWithoutDirectionAreMade) {
    VesperLamp lamp = candle();
    lamp.position[2] = 1;
    add(lamp);
    const std::vector<float> wall{-20, -20, 0, 20, -20, 0, 20, 20, 0, -20, 20, 0}, none(12, 0.0f);
    const std::vector<uint32_t> front{0, 1, 2, 0, 2, 3};
    VesperMesh mesh = square(ground_material);
    mesh.positions = wall.data(), mesh.indices = front.data(), mesh.normals = none.data();
    uint32_t shape = 0, node = 0;
    expect(vesper_scene_add_mesh(scene, &mesh, &shape, &error));
    expect(vesper_scene_add_node(scene, "wall", shape, nullptr, &node, &error));
    VesperView view = down();
    view.eye[1] = 1, view.eye[2] = 0.5f, view.forward[1] = view.up[2] = 0, view.forward[2] = -1, view.up[1] = 1;
    EXPECT_NEAR(render(view)[4 * kMiddle] * kPi, 1, 2e-3);
}

// What a removed node was told is forgotten with it.
TEST_F(CScene, NodesThatAreGoneAreForgotten) {
    VesperLamp lamp = candle();
    lux();
    for (int i = 0; i < 20; ++i) {
        uint32_t frame = 0;
        expect(vesper_scene_add_node(scene, "car", VESPER_NONE, nullptr, &frame, &error));
        const uint32_t node = add(lamp);
        expect(vesper_scene_attach(scene, node, frame, &error));
        expect(vesper_renderer_place(renderer, frame, at(3, 0, 0).data(), &error));
        expect(vesper_renderer_dim(renderer, node, 2, &error));
        EXPECT_NEAR(lux(3), 2, 4e-3);
        expect(vesper_scene_remove(scene, frame, &error));
        EXPECT_EQ(lux(3), 0);
    }
}

// Emission, texture codes through sRGB, sky and ambient light.
TEST_F(CScene, MaterialsAndSky) {
    VesperMaterial shining = white();
    shining.base_colour[0] = shining.base_colour[1] = shining.base_colour[2] = 0, shining.emission[1] = 7;
    VesperMaterial painted = white();
    const uint8_t code[4] = {188, 188, 188, 255};
    painted.texture = code, painted.texture_width = painted.texture_height = 1;
    uint32_t material = 0, mesh = 0, node = 0;
    expect(vesper_scene_add_material(scene, &shining, &material, &error));
    VesperMesh shape = square(material);
    expect(vesper_scene_add_mesh(scene, &shape, &mesh, &error));
    expect(vesper_scene_add_node(scene, nullptr, mesh, at(0, 0.1f, 0).data(), &node, &error));
    EXPECT_EQ(render(down())[4 * kMiddle + 1], 7);
    expect(vesper_scene_remove(scene, node, &error));
    EXPECT_EQ(vesper_scene_add_node(scene, nullptr, mesh, nullptr, &node, &error), VESPER_BAD_ARGUMENT)
        << "no node had it any more";
    expect(vesper_scene_add_material(scene, &painted, &material, &error));
    shape.material = material;
    expect(vesper_scene_add_mesh(scene, &shape, &mesh, &error));
    expect(vesper_scene_add_node(scene, nullptr, mesh, at(0, 0.1f, 0).data(), &node, &error));
    const float ambient[3] = {kPi, 2 * kPi, 0}, sky[3] = {3, 4, 5};
    expect(vesper_scene_set_sky(scene, ambient, sky, &error));
    const std::vector<float> seen = render(down());
    EXPECT_NEAR(seen[4 * kMiddle], 0.5029, 2e-3) << "sRGB code 188";
    EXPECT_NEAR(seen[4 * kMiddle + 1], 2 * 0.5029, 4e-3);
    VesperView up = down();
    up.forward[1] = 1;
    const std::vector<float> above = render(up);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(above[size_t(4 * kMiddle + c)], sky[c], 1e-5f);
}

TEST_F(CScene, NormalsAreOfTheTrianglesOrGiven) {
    add(candle());
    const float flat = lux();
    const std::vector<float> tilted{3, 4, 0, 3, 4, 0, 3, 4, 0, 3, 4, 0};  // cosine 0.8 to the lamp
    VesperMesh mesh = square(ground_material);
    mesh.normals = tilted.data();
    uint32_t index = 0, node = 0;
    expect(vesper_scene_add_mesh(scene, &mesh, &index, &error));
    expect(vesper_scene_remove(scene, ground, &error));
    expect(vesper_scene_add_node(scene, "tilted", index, nullptr, &node, &error));
    EXPECT_NEAR(flat, 1, 2e-3);
    EXPECT_NEAR(lux(), 0.8, 3e-3);
}

TEST_F(CScene, RefusesWhatCannotBe) {
    uint32_t made = 0;
    const auto mesh = [&](const auto& change) {
        VesperMesh m = square(ground_material);
        change(m);
        EXPECT_EQ(vesper_scene_add_mesh(scene, &m, &made, &error), VESPER_BAD_ARGUMENT);
        EXPECT_GT(std::string(error.message).size(), 10u);
    };
    const std::vector<uint32_t> beyond{0, 1, 4, 0, 1, 2};
    const std::vector<float> poison(12, NAN);
    mesh([](VesperMesh& m) { m.size = 4; });
    mesh([](VesperMesh& m) { m.material = 9; });
    mesh([](VesperMesh& m) { m.vertex_count = 2; });
    mesh([](VesperMesh& m) { m.positions = nullptr; });
    mesh([](VesperMesh& m) { m.index_count = 4; });
    mesh([](VesperMesh& m) { m.indices = nullptr; });
    mesh([&](VesperMesh& m) { m.indices = beyond.data(); });
    mesh([&](VesperMesh& m) { m.positions = poison.data(); });
    mesh([&](VesperMesh& m) { m.normals = poison.data(); });
    mesh([&](VesperMesh& m) { m.uvs = poison.data(); });
    const auto material = [&](const auto& change) {
        VesperMaterial m = white();
        change(m);
        EXPECT_EQ(vesper_scene_add_material(scene, &m, &made, &error), VESPER_BAD_ARGUMENT);
    };
    const uint8_t code[4]{};
    material([](VesperMaterial& m) { m.size = 0; });
    material([](VesperMaterial& m) { m.base_colour[1] = 1.01f; });
    material([](VesperMaterial& m) { m.roughness = NAN; });
    material([](VesperMaterial& m) { m.metallic = -1; });
    material([](VesperMaterial& m) { m.emission[2] = -1; });
    material([](VesperMaterial& m) { m.emission[2] = INFINITY; });
    material([&](VesperMaterial& m) { m.texture = code; });
    material([&](VesperMaterial& m) { m.texture = code, m.texture_width = 1, m.texture_height = 20000; });
    const auto lamp = [&](const auto& change) {
        VesperLamp l = candle();
        change(l);
        EXPECT_EQ(vesper_scene_add_lamp(scene, &l, &made, &error), VESPER_BAD_ARGUMENT);
    };
    lamp([](VesperLamp& l) { l.size = 0; });
    lamp([](VesperLamp& l) { l.intensity = -1; });
    lamp([](VesperLamp& l) { l.colour[0] = l.colour[1] = l.colour[2] = 0; });
    lamp([](VesperLamp& l) { l.position[0] = NAN; });
    lamp([](VesperLamp& l) { l.outer_cone = 1; });  // a spot without an axis
    lamp([](VesperLamp& l) { l.outer_cone = 0.5f, l.inner_cone = 0.6f, l.axis[1] = -1; });
    lamp([](VesperLamp& l) { l.outer_cone = 0.5f, l.axis[1] = -1, l.up[1] = 1; });
    lamp([](VesperLamp& l) { l.opening_height = -1; });
    lamp([](VesperLamp& l) { l.opening_height = 0.1f; });  // and no width
    const std::string file = std::string(VESPER_SOURCE_DIR) + "/data/photometry/street-lamp.ies";
    lamp([&](VesperLamp& l) { l.distribution = file.c_str(), l.axis[1] = -1, l.outer_cone = 0.5f; });
    const float flat[16]{}, light[3]{}, negative[3]{-1, 0, 0};
    EXPECT_EQ(vesper_scene_add_node(scene, "", 99, nullptr, &made, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_scene_add_node(scene, "", VESPER_NONE, flat, &made, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_scene_remove(scene, 99, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_scene_set_sky(scene, negative, light, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_scene_set_sky(scene, nullptr, light, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_scene_create(nullptr, &error), VESPER_BAD_ARGUMENT);
    for (const VesperResult result :
         {vesper_scene_add_mesh(nullptr, nullptr, &made, &error),
          vesper_scene_add_material(nullptr, nullptr, &made, &error),
          vesper_scene_add_node(nullptr, "", VESPER_NONE, nullptr, &made, &error),
          vesper_scene_add_lamp(nullptr, nullptr, nullptr, &error), vesper_scene_attach(nullptr, 1, 0, &error),
          vesper_scene_remove(nullptr, 0, &error), vesper_renderer_dim(nullptr, 0, 1, &error),
          vesper_renderer_finish(nullptr, nullptr, &error), vesper_renderer_reset(nullptr, &error),
          vesper_renderer_eye(nullptr, nullptr, &error),
          vesper_renderer_gather_light(nullptr, nullptr, nullptr, &error)})
        EXPECT_EQ(result, VESPER_BAD_ARGUMENT);
    EXPECT_EQ(lux(), 0) << "none of that is in the scene";
    VesperView view = down();
    view.camera = "driver";
    VesperOutputs outputs = VESPER_INIT(VesperOutputs);
    EXPECT_EQ(vesper_render(renderer, nullptr, &view, 0, &outputs, &error), VESPER_FAILED);
    EXPECT_TRUE(std::string(error.message).starts_with("the scene: no camera 'driver'")) << error.message;
    EXPECT_EQ(vesper_renderer_dim(renderer, 99, 1, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_renderer_dim(renderer, ground, -1, &error), VESPER_BAD_ARGUMENT);
    uint32_t empty = VESPER_NONE;
    expect(vesper_scene_add_node(scene, "empty", VESPER_NONE, nullptr, &empty, &error));
    EXPECT_EQ(vesper_renderer_dim(renderer, empty, 1, &error), VESPER_BAD_ARGUMENT) << "nothing there gives light";
    // No host has images of a device that Vesper opened.
    VesperImage image = VESPER_INIT(VesperImage);
    image.image = reinterpret_cast<VkImage>(uintptr_t{64}), image.format = VK_FORMAT_R8G8B8A8_UNORM,
    image.width = image.height = kSide;
    image.layout_after = VK_IMAGE_LAYOUT_GENERAL;
    view = down();
    EXPECT_EQ(vesper_render_image(renderer, nullptr, &view, 0, &image, nullptr, &error), VESPER_BAD_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("host's device"), std::string::npos) << error.message;
}

}  // namespace
}  // namespace vesper::test
