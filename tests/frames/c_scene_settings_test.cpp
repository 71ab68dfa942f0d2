// How scenes made in memory are drawn, by settings of the C interface. SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/c_scene.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

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
        EXPECT_EQ(std::distance(std::filesystem::directory_iterator(maps), {}), 2) << run << ": a map, and the secret";
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
