// Channels: one eye, several screens, no seams. SPDX-License-Identifier: MIT
#include "channels.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/luminance.h"
#include "places.h"
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr uint32_t kSide = 96;

// A wall 20 m ahead, evenly lit, and a lamp before it far to the left: to all sides, or to the eye alone.
Scene wall_scene(float ambient, float candela, Light::Kind kind) {
    Scene scene;
    scene.name = "wall";
    scene.materials.push_back({.name = "grey", .base_colour = {0.3f, 0.3f, 0.3f, 1}});
    Primitive wall;
    for (const glm::vec3 corner : {glm::vec3(-80, -40, -20), {80, -40, -20}, {80, 40, -20}, {-80, 40, -20}}) {
        wall.vertices.push_back({.position = corner, .normal = {0, 0, 1}});
        wall.bounds.add(corner);
    }
    wall.indices = {0, 1, 2, 0, 2, 3};
    scene.meshes.push_back({"wall", {wall}});
    scene.nodes.push_back({.name = "wall", .mesh = 0});
    scene.lights.push_back({.name = "lamp", .kind = kind, .intensity = candela, .inner_cone = 0.1f, .outer_cone = 0.2f, .opening = {.length = 0.3f, .width = 0.3f}});
    scene.nodes.push_back({.name = "lamp", .translation = {-19.0f * std::tan(float(32 * kDegree)), 0, -19}, .rotation = glm::angleAxis(float(212 * kDegree), glm::vec3(0, 1, 0)), .light = 0});
    scene.ambient_illuminance = ambient;
    return scene;
}

// Three screens in one plane: a picture cut in three, and the picture itself.
Channels three() {
    Channels channels;
    const double edge = std::tan(16 * kDegree);
    for (int i = -1; i <= 1; ++i)
        channels.screens.push_back({.name = std::to_string(i), .extent = {kSide, kSide}, .left = std::atan((2 * i - 1) * edge), .right = std::atan((2 * i + 1) * edge), .bottom = -16 * kDegree, .top = 16 * kDegree});
    channels.gaze = 1;
    return channels;
}

View whole() {
    View view;
    const float edge = float(std::tan(16 * kDegree));
    view.extent = {3 * kSide, kSide};
    view.tangent_low = {-3 * edge, -edge}, view.tangent_high = {3 * edge, edge};
    return view;
}

double code(const ToneMapped& shown, uint32_t x, uint32_t y) { return shown.display[4 * (size_t(y) * shown.extent.width + x) + 1]; }

// What jumps from one screen to the next, beyond how codes change beside the seam.
double step_at(const ToneMapped& shown, uint32_t seam) {
    double worst = 0;
    for (uint32_t y = 0; y < kSide; ++y) {
        const double across = code(shown, seam, y) - code(shown, seam - 1, y);
        const double beside = (code(shown, seam + 1, y) - code(shown, seam, y) + code(shown, seam - 1, y) - code(shown, seam - 2, y)) / 2;
        worst = std::max(worst, std::abs(across - beside));
    }
    return worst;
}

struct Rig {
    Device device{{.select = ""}};
    Scene scene;
    Renderer renderer;
    ChannelRenderer wall{device};
    SceneFrame frame;
    explicit Rig(Scene s) : scene(std::move(s)), renderer(device, scene), frame{.world = world_transforms(scene, 0), .dimming = {}, .ambient = {}, .tunnels = {}} {}
};

// Without glare, three screens are the picture they are cut from: the only lamp is on the left one. Luminances differ by what
// shading adds up over blocks (0.1 %), codes by one.
TEST(Channels, AreThePictureTheyAreCutFrom) {
    Rig rig(wall_scene(0.5f, 300, Light::Kind::Point));
    RenderSettings settings;
    const Wall wall = rig.wall.render(rig.renderer, three(), settings, View::symmetric({1, 1}, 1, glm::mat4(1)), rig.frame, 0, {.display = true, .scene = true});
    const Frame one = rig.renderer.render(settings, whole(), rig.frame, 0, {.display = true, .scene = true});
    ASSERT_EQ(wall.shown.display.size(), one.display.size());
    int far = 0;
    for (size_t i = 0; i < one.display.size(); ++i) far += std::abs(int(one.display[i]) - int(wall.shown.display[i])) > 1;
    EXPECT_LE(far, int(one.display.size() / 1000));
    for (size_t i = 0; i < one.scene.size(); ++i) ASSERT_NEAR(wall.shown.scene[i], one.scene[i], 0.004 * one.scene[i] + 1e-6) << i;
    EXPECT_LE(step_at(wall.shown, kSide), 2);
    EXPECT_LE(step_at(wall.shown, 2 * kSide), 2);

    // Each by itself, the left screen has the lamp to adapt to and the others have not.
    ToneMapped alone = wall.shown;
    for (uint32_t i = 0; i < 3; ++i) {
        Renderer renderer(rig.device, rig.scene);
        const Frame part = renderer.render(settings, channel_view(three().screens[i], View::symmetric({1, 1}, 1, glm::mat4(1))), rig.frame, 0, {.display = true});
        for (uint32_t y = 0; y < kSide; ++y) std::copy_n(&part.display[4 * y * kSide], 4 * kSide, &alone.display[4 * (y * 3 * kSide + i * kSide)]);
    }
    EXPECT_GT(step_at(alone, kSide), 8);
}

// The lamp dazzles: its light is scattered into the screens beside, where it is a lamp out of the picture. A veil from beside
// and one from within are fitted apart (within 8 %, docs/glare.md).
TEST(Channels, GlareGoesOnAcrossTheSeam) {
    Rig rig(wall_scene(0.02f, 20000, Light::Kind::Spot));
    RenderSettings settings;
    settings.glare = Glare::Scatter;
    const View driver = View::symmetric({1, 1}, 1, glm::mat4(1));
    const Wall wall = rig.wall.render(rig.renderer, three(), settings, driver, rig.frame, 0, {.display = true, .scene = true});
    RenderSettings clear = settings;
    clear.glare = Glare::None;
    const Wall without = rig.wall.render(rig.renderer, three(), clear, driver, rig.frame, 0, {.display = true, .scene = true});
    const auto veil = [&](uint32_t x) {
        const size_t at = 4 * (size_t(kSide / 2) * 3 * kSide + x);
        return double(wall.shown.scene[at + 1] - without.shown.scene[at + 1]);
    };
    for (const uint32_t seam : {kSide, 2 * kSide}) {
        const double left = veil(seam - 2), right = veil(seam + 1);
        EXPECT_GT(right, 0.01);
        EXPECT_NEAR(right / left, 1, 0.15) << seam;
    }
    EXPECT_LE(step_at(wall.shown, kSide), 4);
    EXPECT_LE(step_at(wall.shown, 2 * kSide), 4);
}

TEST(Channels, TurnedScreensSeeWhereTheyLook) {
    const View driver = View::symmetric({1, 1}, 1, glm::mat4(1));
    const auto ahead = [&](double yaw, double pitch) {
        ScreenChannel c{.name = "", .yaw = yaw, .pitch = pitch, .left = -0.1, .right = 0.1, .bottom = -0.1, .top = 0.1};
        return glm::vec3(glm::inverse(channel_view(c, driver).world_to_view) * glm::vec4(0, 0, -1, 0));
    };
    EXPECT_LT(glm::distance(ahead(90 * kDegree, 0), glm::vec3(-1, 0, 0)), 1e-6);
    EXPECT_LT(glm::distance(ahead(0, 90 * kDegree), glm::vec3(0, 1, 0)), 1e-6);
    const ScreenChannel rolled{.name = "", .roll = 90 * kDegree, .left = -0.1, .right = 0.1, .bottom = -0.1, .top = 0.1};
    // Rolled clockwise, what is up in the picture lies to the right.
    EXPECT_LT(glm::distance(glm::vec3(glm::inverse(channel_view(rolled, driver).world_to_view) * glm::vec4(0, 1, 0, 0)), glm::vec3(1, 0, 0)), 1e-6);
}

TEST(Channels, FilesAreReadOrRefused) {
    const std::string data = std::string(VESPER_SOURCE_DIR) + "/data/channels/";
    EXPECT_EQ(read_channels(data + "one-screen.json").screens.size(), 1u);
    const Channels screens = read_channels(data + "three-screens.json");
    EXPECT_EQ(screens.screens.size(), 3u);
    EXPECT_EQ(screens.gaze, 1u);
    const TempFolder folder;
    for (const char* bad : {"{}", R"({"version": 1, "channels": []})", R"({"version": 1, "gaze": "x", "channels": [{"name": "a", "size_px": [8, 8], "left_deg": -1, "right_deg": 1, "bottom_deg": -1, "top_deg": 1}]})",
                            R"({"version": 1, "channels": [{"name": "a", "size_px": [8, 8], "left_deg": 1, "right_deg": -1, "bottom_deg": -1, "top_deg": 1}]})",
                            R"({"version": 1, "channels": [{"name": "a", "size_px": [0, 8], "left_deg": -1, "right_deg": 1, "bottom_deg": -1, "top_deg": 1}]})"})
        EXPECT_THROW(read_channels(folder.write("bad.json", bad)), Error) << bad;
}

}  // namespace
}  // namespace vesper::test
