// Scenes made in memory through the C interface: light by the laws it follows, and what is added, hung on something,
// dimmed and removed. SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "photometry/distribution.h"
#include "photometry/ies.h"
#include "places.h"
#include "support/c_scene.h"
#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

class CScene : public ::testing::Test {
protected:
    void SetUp() override {
        VesperDeviceOptions options = VESPER_INIT(VesperDeviceOptions);
        options.validation = 1, options.user = &complaints;
        options.on_message = [](const char* message, void* user) { *static_cast<std::string*>(user) += message; };
        expect(vesper_device_open(&options, &device, &error));
        expect(vesper_scene_create(&scene, &error));
        const VesperMaterial material = white();
        expect(vesper_scene_add_material(scene, &material, &ground_material, &error));
        const VesperMesh mesh = square(ground_material);
        expect(vesper_scene_add_mesh(scene, &mesh, &ground_mesh, &error));
        expect(vesper_scene_add_node(scene, "ground", ground_mesh, nullptr, &ground, &error));
    }
    void TearDown() override {
        vesper_renderer_destroy(renderer), vesper_scene_destroy(scene), vesper_device_close(device);
        EXPECT_EQ(complaints, "");
    }
    void expect(VesperResult result) { ASSERT_EQ(result, VESPER_OK) << error.message; }
    uint32_t add(const VesperLamp& lamp) {
        uint32_t node = VESPER_NONE;
        expect(vesper_scene_add_lamp(scene, &lamp, &node, &error));
        return node;
    }
    std::vector<float> render(const VesperView& view) {
        if (!renderer) expect(vesper_renderer_create(device, scene, &renderer, &error));
        std::vector<float> luminance(4 * kSide * kSide);
        VesperOutputs outputs = VESPER_INIT(VesperOutputs);
        outputs.luminance = luminance.data();
        expect(vesper_render(renderer, nullptr, &view, 0, &outputs, &error));
        return luminance;
    }
    // Illuminance on the white, matt ground below, lx.
    float lux(float x = 0) { return render(down(x))[4 * kMiddle] * kPi; }

    std::string complaints;
    VesperDevice* device = nullptr;
    VesperScene* scene = nullptr;
    VesperRenderer* renderer = nullptr;
    uint32_t ground_material = 0, ground_mesh = 0, ground = 0;
    VesperError error;
};

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

TEST_F(CScene, PixelsMayHaveSamples) {
    add(candle());
    VesperView view = down();
    const std::vector<float> smooth = render(view);
    expect(vesper_set(renderer, "samples", 1, &error));
    EXPECT_EQ(render(view), smooth);
    expect(vesper_set(renderer, "samples", 16, &error));
    const std::vector<float> many = render(view);
    EXPECT_NE(many, smooth);
    EXPECT_NEAR(many[4 * kMiddle], smooth[4 * kMiddle], 1e-3f * smooth[4 * kMiddle]);
    for (const double wrong : {65537.0, 0.0, 1.5})
        EXPECT_EQ(vesper_set(renderer, "samples", wrong, &error), VESPER_BAD_ARGUMENT) << wrong;
    EXPECT_EQ(render(view), many);
}

// A value that is set stays whatever the set, as on the command line.
TEST_F(CScene, RenderersHaveAQuality) {
    add(candle());
    VesperView view = down();
    const std::vector<float> standard = render(view);
    EXPECT_GT(standard[4 * kMiddle], 0);
    expect(vesper_set(renderer, "threshold", 10, &error));  // the candle gives the ground 1 lx
    EXPECT_EQ(render(view)[4 * kMiddle], 0);
    expect(vesper_set_quality(renderer, "exact", &error));
    EXPECT_EQ(render(view)[4 * kMiddle], 0);
    expect(vesper_unset(renderer, "threshold", &error));
    EXPECT_NEAR(render(view)[4 * kMiddle], standard[4 * kMiddle], 1e-3f * standard[4 * kMiddle]);
    EXPECT_EQ(vesper_set_quality(renderer, "best", &error), VESPER_BAD_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("fast, interactive, standard, exact"), std::string::npos)
        << error.message;
    expect(vesper_set_quality(renderer, "standard", &error));
    EXPECT_EQ(render(view), standard);
}

TEST_F(CScene, SettingsAreListedSetAndReadByName) {
    add(candle());
    render(down());
    ASSERT_GT(vesper_setting_count(), 10u);
    std::set<std::string> names;
    for (uint32_t i = 0; i < vesper_setting_count(); ++i) {
        VesperSetting setting = VESPER_INIT(VesperSetting);
        expect(vesper_setting_at(i, &setting, &error));
        EXPECT_TRUE(names.insert(setting.name).second) << setting.name;
        EXPECT_GT(std::string(setting.help).size(), 10u) << setting.name;
        EXPECT_LT(setting.low, setting.high) << setting.name;
        double value = -1;
        expect(vesper_get(renderer, setting.name, &value, &error));
        EXPECT_EQ(value, setting.standard) << setting.name;
        expect(vesper_set(renderer, setting.name, setting.exact, &error));
        expect(vesper_get(renderer, setting.name, &value, &error));
        EXPECT_EQ(value, setting.exact) << setting.name;
        EXPECT_EQ(vesper_set(renderer, setting.name, setting.low - 1, &error), VESPER_BAD_ARGUMENT) << setting.name;
        EXPECT_NE(std::string(error.message).find(setting.name), std::string::npos) << error.message;
    }
    for (const char* name : {"threshold", "shadow-error", "anti-aliasing", "indirect"})
        EXPECT_TRUE(names.contains(name));
    EXPECT_EQ(vesper_set(renderer, "threshold", 5000, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(std::string(error.message), "threshold 5000: a number from 1e-09 to 1000 lx is expected");
    double value = 0;
    for (const char* name : {"no-shadows", "scale", ""}) {
        EXPECT_EQ(vesper_set(renderer, name, 1, &error), VESPER_BAD_ARGUMENT) << name;
        EXPECT_EQ(vesper_get(renderer, name, &value, &error), VESPER_BAD_ARGUMENT) << name;
    }
    EXPECT_EQ(vesper_set(renderer, nullptr, 1, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_set(nullptr, "samples", 1, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_setting_at(vesper_setting_count(), nullptr, &error), VESPER_BAD_ARGUMENT);
}

// Shadow maps that a host keeps: a second renderer has the same light.
TEST_F(CScene, ShadowsMayBeKept) {
    add(candle());
    uint32_t plate = VESPER_NONE;
    expect(vesper_scene_add_node(scene, "plate", ground_mesh, at(0, 0.75f, 0).data(), &plate, &error));
    const std::vector<float> without = render(down(0.4f));
    const TempFolder folder;
    const std::string maps = (folder / "of/maps").string();
    for (const char* run : {"cold", "warm"}) {
        vesper_renderer_destroy(renderer), renderer = nullptr;
        expect(vesper_renderer_create(device, scene, &renderer, &error));
        expect(vesper_renderer_set_cache(renderer, maps.c_str(), &error));
        EXPECT_EQ(render(down(0.4f)), without) << run;
        EXPECT_EQ(std::distance(std::filesystem::directory_iterator(maps), {}), 1) << run;
    }
    const std::string file = folder.write("file", "").string();
    for (const std::string& bad : {file, file + "/maps"}) {
        EXPECT_EQ(vesper_renderer_set_cache(renderer, bad.c_str(), &error), VESPER_FAILED);
        EXPECT_NE(std::string(error.message).find(bad), std::string::npos) << error.message;
    }
    EXPECT_EQ(vesper_renderer_set_cache(renderer, "", &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_renderer_set_cache(nullptr, nullptr, &error), VESPER_BAD_ARGUMENT);
    expect(vesper_renderer_set_cache(renderer, nullptr, &error));
    std::filesystem::remove_all(maps);
    expect(vesper_scene_attach(scene, plate, ground, &error));
    EXPECT_EQ(render(down(0.4f)), without);
    EXPECT_FALSE(std::filesystem::exists(maps));
}

// A large plate of 1 cd/m^2 hangs over the ground: pi lx by its light, 0.8 % less at its middle. 10 %: noise of
// nine cells.
TEST_F(CScene, EmittingSurfacesLightOnceThatIsGathered) {
    VesperMaterial glow = white();
    uint32_t material = VESPER_NONE, mesh = VESPER_NONE, plate = VESPER_NONE;
    for (int i = 0; i < 3; ++i) glow.base_colour[i] = 0, glow.emission[i] = 1;
    expect(vesper_scene_add_material(scene, &glow, &material, &error));
    const VesperMesh shape = square(material);
    expect(vesper_scene_add_mesh(scene, &shape, &mesh, &error));
    const float turned[]{1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 2, 0, 1};
    expect(vesper_scene_add_node(scene, "plate", mesh, turned, &plate, &error));
    EXPECT_EQ(lux(), 0);
    double share = 0;
    const VesperProgress keep = [](double done, void* user) {
        *static_cast<double*>(user) = done;
        return 1;
    };
    const VesperProgress stop = [](double, void*) { return 0; };
    EXPECT_EQ(vesper_renderer_gather_light(renderer, stop, nullptr, &error), VESPER_FAILED);
    EXPECT_EQ(lux(), 0);
    expect(vesper_renderer_gather_light(renderer, keep, &share, &error));
    EXPECT_GT(share, 0);
    EXPECT_NEAR(lux(), kPi, 0.1 * kPi);
    VesperView view = down();
    expect(vesper_set(renderer, "indirect", 0, &error));
    EXPECT_EQ(render(view)[4 * kMiddle], 0);
    expect(vesper_set(renderer, "indirect", 1, &error));
    view.forward[1] = 1;
    EXPECT_EQ(render(view)[4 * kMiddle], 1);
    expect(vesper_renderer_dim(renderer, plate, 0.5f, &error));
    EXPECT_EQ(render(view)[4 * kMiddle], 0.5f);
    EXPECT_NEAR(lux(), kPi / 2, 0.05 * kPi);
    expect(vesper_renderer_dim(renderer, plate, 0, &error));
    EXPECT_EQ(lux(), 0);
    expect(vesper_renderer_dim(renderer, plate, 1, &error));
    expect(vesper_renderer_place(renderer, plate, at(0, 500, 0).data(), &error));
    EXPECT_EQ(lux(), 0) << "what moves now gives no light";
    add(candle());
    EXPECT_NEAR(lux(), 1, 2e-3) << "of another scene nothing is gathered";
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

// A screen beside the eye: its middle is seen at 63.4 degrees from straight ahead.
TEST_F(CScene, EdgesMayLieToOneSide) {
    add(candle());
    VesperView view = down();
    const float edges[4]{1.98f, 2.02f, -0.01f, 0.01f};
    std::copy(edges, edges + 4, view.edges);
    EXPECT_NEAR(render(view)[4 * kMiddle] * kPi, 1 / std::pow(2.0f, 1.5f), 1e-3)
        << "cos / d^2, 1 m from below the lamp";
    const auto refused = [&](int edge, float value) {
        VesperView wrong = view;
        wrong.edges[edge] = value;
        VesperOutputs outputs = VESPER_INIT(VesperOutputs);
        EXPECT_EQ(vesper_render(renderer, nullptr, &wrong, 0, &outputs, &error), VESPER_BAD_ARGUMENT);
    };
    refused(0, 2.02f), refused(3, -0.01f), refused(1, NAN), refused(2, -INFINITY);
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

// The eye of one renderer goes on in another.
TEST_F(CScene, EyesAreKept) {
    VesperLamp lamp = candle();
    lamp.intensity = 1000;
    const uint32_t node = add(lamp);
    std::vector<uint8_t> codes(4 * kSide * kSide);
    VesperOutputs outputs = VESPER_INIT(VesperOutputs);
    outputs.codes = codes.data();
    const VesperView view = down();
    const auto show = [&](VesperRenderer* by, float seconds) {
        expect(vesper_render(by, nullptr, &view, seconds, &outputs, &error));
        return codes;
    };
    expect(vesper_renderer_create(device, scene, &renderer, &error));
    show(renderer, 0);
    std::vector<uint8_t> eye(vesper_eye_size());
    expect(vesper_renderer_eye(renderer, eye.data(), &error));
    expect(vesper_renderer_dim(renderer, node, 0.001f, &error));
    const std::vector<uint8_t> blinded = show(renderer, 0.1f);
    VesperRenderer* other = nullptr;
    expect(vesper_renderer_create(device, scene, &other, &error));
    expect(vesper_renderer_dim(other, node, 0.001f, &error));
    const std::vector<uint8_t> rested = show(other, 0.1f);
    expect(vesper_renderer_set_eye(other, eye.data(), eye.size(), &error));
    EXPECT_EQ(show(other, 0.1f), blinded);
    EXPECT_NE(rested, blinded);
    expect(vesper_renderer_reset(other, &error));
    EXPECT_EQ(show(other, 0.1f), rested);
    eye[0] ^= 1;
    EXPECT_EQ(vesper_renderer_set_eye(other, eye.data(), eye.size(), &error), VESPER_BAD_ARGUMENT);
    vesper_renderer_destroy(other);
}

}  // namespace
}  // namespace vesper::test
