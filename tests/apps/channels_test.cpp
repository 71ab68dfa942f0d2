// Channels: one eye, several screens, no seams. SPDX-License-Identifier: MIT
#include "channels/channels.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.h"
#include "base/error.h"
#include "base/luminance.h"
#include "passes/eye_scatter_reference.h"
#include "places.h"
#include "scene/scene_files.h"
#include "support/complaints.h"

namespace vesper::test {
namespace {

using drive::ChannelMosaic, drive::Channels;
using gpu_scene::View;

constexpr uint32_t kSide = 96;

// A wall 20 m ahead, evenly lit, and a lamp before it far to the left: to all sides, or to the eye alone.
scene::Scene wall_scene(float ambient, float candela, scene::Lamp::Kind kind) {
    scene::Scene scene;
    scene.name = "wall";
    scene.materials.push_back({.name = "grey", .base_colour = {0.3f, 0.3f, 0.3f, 1}});
    scene::Primitive wall;
    for (const glm::vec3 corner : {glm::vec3(-80, -40, -20), {80, -40, -20}, {80, 40, -20}, {-80, 40, -20}}) {
        wall.vertices.push_back({.position = corner, .normal = {0, 0, 1}});
        wall.bounds.add(corner);
    }
    wall.indices = {0, 1, 2, 0, 2, 3};
    scene.meshes.push_back({"wall", {wall}});
    scene.nodes.push_back({.name = "wall", .mesh = 0});
    scene.lamps.push_back({.name = "lamp",
                           .kind = kind,
                           .intensity = candela,
                           .inner_cone = 0.1f,
                           .outer_cone = 0.2f,
                           .opening = {.length = 0.3f, .width = 0.3f}});
    scene.nodes.push_back({.name = "lamp",
                           .translation = {-19.0f * std::tan(float(32 * kRadiansPerDegree)), 0, -19},
                           .rotation = glm::angleAxis(float(212 * kRadiansPerDegree), glm::vec3(0, 1, 0)),
                           .lamp = 0});
    scene.ambient_illuminance = ambient;
    return scene;
}

// Three screens in one plane: a picture cut in three, and the picture itself.
Channels three() {
    Channels channels;
    const double edge = std::tan(16 * kRadiansPerDegree);
    for (int i = -1; i <= 1; ++i)
        channels.screens.push_back({.name = std::to_string(i),
                                    .extent = {kSide, kSide},
                                    .left = std::atan((2 * i - 1) * edge),
                                    .right = std::atan((2 * i + 1) * edge),
                                    .bottom = -16 * kRadiansPerDegree,
                                    .top = 16 * kRadiansPerDegree});
    channels.gaze = 1;
    return channels;
}

View whole() {
    View view;
    const float edge = float(std::tan(16 * kRadiansPerDegree));
    view.extent = {3 * kSide, kSide};
    view.tangent_low = {-3 * edge, -edge}, view.tangent_high = {3 * edge, edge};
    return view;
}

double code(const render::ToneMapped& shown, uint32_t x, uint32_t y) {
    return shown.display[4 * (size_t(y) * shown.extent.width + x) + 1];
}

// What jumps from one screen to the next, beyond how codes change beside the seam.
double step_at(const render::ToneMapped& shown, uint32_t seam) {
    double worst = 0;
    for (uint32_t y = 0; y < kSide; ++y) {
        const double across = code(shown, seam, y) - code(shown, seam - 1, y);
        const double beside =
            (code(shown, seam + 1, y) - code(shown, seam, y) + code(shown, seam - 1, y) - code(shown, seam - 2, y)) / 2;
        worst = std::max(worst, std::abs(across - beside));
    }
    return worst;
}

struct Rig {
    gpu::Device device{{.select = ""}};
    scene::Scene scene;
    render::Renderer renderer;
    drive::ChannelRenderer wall{device};
    gpu_scene::SceneFrame frame;
    explicit Rig(scene::Scene s)
        : scene(std::move(s)),
          renderer(device, scene),
          frame{.world = scene::world_transforms(scene, 0), .dimming = {}, .ambient = {}, .tunnels = {}} {}
};

// Without glare, three screens are the picture they are cut from: the only lamp is on the left one. Luminances differ
// by what shading adds up over blocks (0.1 %), codes by one.
TEST(Channels, AreThePictureTheyAreCutFrom) {
    Rig rig(wall_scene(0.5f, 300, scene::Lamp::Kind::Point));
    render::RenderSettings settings;
    const ChannelMosaic wall =
        rig.wall.render(rig.renderer, three(), settings, View::symmetric({1, 1}, 1, glm::mat4(1)), rig.frame, 0,
                        {.display = true, .scene = true, .retina = true});
    const render::Frame one = rig.renderer.render(settings, whole(), rig.frame, 0, {.display = true, .scene = true});
    ASSERT_EQ(wall.shown.display.size(), one.display.size());
    int far = 0;
    for (size_t i = 0; i < one.display.size(); ++i)
        far += std::abs(int(one.display[i]) - int(wall.shown.display[i])) > 1;
    EXPECT_LE(far, int(one.display.size() / 1000));
    for (size_t i = 0; i < one.scene.size(); ++i)
        ASSERT_NEAR(wall.shown.scene[i], one.scene[i], 0.004 * one.scene[i] + 1e-6) << i;
    EXPECT_LE(step_at(wall.shown, kSide), 2);
    EXPECT_LE(step_at(wall.shown, 2 * kSide), 2);

    // Each by itself, the left screen has the lamp to adapt to and the others have not.
    render::ToneMapped alone = wall.shown;
    for (uint32_t i = 0; i < 3; ++i) {
        render::Renderer renderer(rig.device, rig.scene);
        const render::Frame part =
            renderer.render(settings, drive::channel_view(three().screens[i], View::symmetric({1, 1}, 1, glm::mat4(1))),
                            rig.frame, 0, {.display = true});
        for (uint32_t y = 0; y < kSide; ++y)
            std::copy_n(&part.display[4 * y * kSide], 4 * kSide, &alone.display[4 * (y * 3 * kSide + i * kSide)]);
    }
    EXPECT_GT(step_at(alone, kSide), 8);
}

// The lamp dazzles: its light is scattered into the screens beside. Two pixels to either side of the seam the veil
// falls by what it does there, 5 %.
TEST(Channels, GlareGoesOnAcrossTheSeam) {
    Rig rig(wall_scene(0.02f, 20000, scene::Lamp::Kind::Spot));
    render::RenderSettings settings;
    settings.glare = render::Glare::Scatter;
    const View driver = View::symmetric({1, 1}, 1, glm::mat4(1));
    const ChannelMosaic wall = rig.wall.render(rig.renderer, three(), settings, driver, rig.frame, 0,
                                               {.display = true, .scene = true, .retina = true});
    render::RenderSettings clear = settings;
    clear.glare = render::Glare::None;
    const ChannelMosaic without = rig.wall.render(rig.renderer, three(), clear, driver, rig.frame, 0,
                                                  {.display = true, .scene = true, .retina = true});
    const auto veil = [&](uint32_t x) {
        const size_t at = 4 * (size_t(kSide / 2) * kSide + x % kSide);
        return double(wall.channels[x / kSide].retina[at + 1] - without.channels[x / kSide].scene[at + 1]);
    };
    // Luminance is that of the scene, whatever the eye scatters; 0.4 %: what shading adds up over blocks.
    for (size_t i = 0; i < wall.shown.scene.size(); ++i)
        ASSERT_NEAR(wall.shown.scene[i], without.shown.scene[i], 0.004 * without.shown.scene[i] + 1e-6) << i;
    for (size_t c = 0; c < 3; ++c)
        for (size_t i = 0; i < wall.channels[c].scene.size(); ++i)
            ASSERT_NEAR(wall.channels[c].scene[i], without.channels[c].scene[i],
                        0.004 * without.channels[c].scene[i] + 1e-6)
                << i;
    for (const uint32_t seam : {kSide, 2 * kSide}) {
        const double left = veil(seam - 2), right = veil(seam + 1);
        EXPECT_GT(right, 0.01);
        EXPECT_NEAR(right / left, 1, 0.15) << seam;
    }
    EXPECT_LE(step_at(wall.shown, kSide), 4);
    EXPECT_LE(step_at(wall.shown, 2 * kSide), 4);
}

// A luminous sign, 4 x 3 degrees, 1000 cd/m^2, so many degrees to the left of the driver, and nothing else.
scene::Scene sign_scene(double degrees) {
    scene::Scene scene;
    scene.name = "sign";
    scene.materials.push_back({.name = "luminous", .base_colour = {0, 0, 0, 1}, .emission = {1000, 600, 200}});
    const glm::mat4 turn = glm::rotate(glm::mat4(1), float(degrees * kRadiansPerDegree), glm::vec3(0, 1, 0));
    scene::Primitive sign;
    const float x = 20 * float(std::tan(2 * kRadiansPerDegree)), y = 20 * float(std::tan(1.5 * kRadiansPerDegree));
    for (const glm::vec3 corner : {glm::vec3(-x, -y, -20), {x, -y, -20}, {x, y, -20}, {-x, y, -20}}) {
        const glm::vec3 at(turn * glm::vec4(corner, 1));
        sign.vertices.push_back({.position = at, .normal = glm::vec3(turn * glm::vec4(0, 0, 1, 0))});
        sign.bounds.add(at);
    }
    sign.indices = {0, 1, 2, 0, 2, 3};
    scene.meshes.push_back({"sign", {sign}});
    scene.nodes.push_back({.name = "sign", .mesh = 0});
    return scene;
}

// Three screens of a simulator, 48 degrees from axis to axis, side by side. The middle one has another resolution.
Channels turned_screens() {
    Channels channels;
    for (int i = -1; i <= 1; ++i) {
        const uint32_t side = i == 0 ? 120 : kSide;
        channels.screens.push_back({.name = std::to_string(i),
                                    .extent = {side, side},
                                    .yaw = -48 * i * kRadiansPerDegree,
                                    .left = -24 * kRadiansPerDegree,
                                    .right = 24 * kRadiansPerDegree,
                                    .bottom = -16 * kRadiansPerDegree,
                                    .top = 16 * kRadiansPerDegree});
    }
    channels.gaze = 1;
    return channels;
}

const render::RenderSettings kScattering = [] {
    render::RenderSettings settings;
    settings.glare = render::Glare::Scatter;
    return settings;
}();

// Luminance of a column of the wall at a part of the height, on the retina; rows in between are linear.
double seen_at(const ChannelMosaic& wall, size_t channel, int column, double part) {
    const VkExtent2D extent = wall.channels[channel].extent;
    const double row = part * extent.height - 0.5, first = std::floor(row);
    const size_t x = column < 0 ? extent.width - size_t(-column) : size_t(column);
    const auto at = [&](double y) { return double(wall.channels[channel].retina[4 * (size_t(y) * extent.width + x)]); };
    return std::lerp(at(first), at(first + 1), row - first);
}

// The only light is a lit surface on the left screen. At a seam the veils on either side, each continued by half a
// pixel, are one: within 1 %, and within 4 % where the sign is 18 px from it, since each picture's own pyramid is good
// to 3 % there (docs/glare.md: 10 to 30 px).
TEST(Channels, GlareOfLitSurfacesHasNoSeam) {
    struct Case {
        Channels channels;
        double degrees, largest;
    };
    const Case cases[]{{three(), 30, 0.01}, {turned_screens(), 35, 0.04}, {turned_screens(), 60, 0.01}};
    for (const Case& c : cases) {
        Rig rig(sign_scene(c.degrees));
        const ChannelMosaic wall =
            rig.wall.render(rig.renderer, c.channels, kScattering, View::symmetric({1, 1}, 1, glm::mat4(1)), rig.frame,
                            0, {.display = true, .scene = true, .retina = true});
        for (const size_t seam : {0u, 1u})
            for (const double part : {0.1, 0.3, 0.5, 0.77}) {
                const auto to_edge = [&](size_t channel, int edge, int next) {
                    return 1.5 * seen_at(wall, channel, edge, part) - 0.5 * seen_at(wall, channel, next, part);
                };
                const double left = to_edge(seam, -1, -2), right = to_edge(seam + 1, 0, 1);
                EXPECT_GT(right, 0.002);
                EXPECT_NEAR(right / left, 1, c.largest)
                    << "seam " << seam << ", " << part << " of the height, sign at " << c.degrees;
            }
        EXPECT_EQ(wall.shown.display,
                  rig.wall
                      .render(rig.renderer, c.channels, kScattering, View::symmetric({1, 1}, 1, glm::mat4(1)),
                              rig.frame, 0, {.display = true})
                      .shown.display);
    }
}

// The same against the definition: the sum over every pixel of the screen that has the sign, as it is without glare. 3
// %: with how few pixels the sign is drawn (1 % of its area), and the pyramid (1.5 %).
TEST(Channels, GlareOfOtherScreensIsWhatTheyShow) {
    Rig rig(sign_scene(35));
    const Channels channels = turned_screens();
    const View driver = View::symmetric({1, 1}, 1, glm::mat4(1));
    render::RenderSettings clear;
    const ChannelMosaic seen = rig.wall.render(rig.renderer, channels, kScattering, driver, rig.frame, 0,
                                               {.display = true, .retina = true}),
                        shown = rig.wall.render(rig.renderer, channels, clear, driver, rig.frame, 0,
                                                {.display = true, .scene = true});
    const auto towards = [&](size_t channel, glm::dvec2 pixels) {
        const View view = drive::channel_view(channels.screens[channel], driver);
        return glm::transpose(glm::dmat3(view.world_to_view)) *
               reference::direction_of(gpu_scene::angles_of(view), pixels);
    };
    const vision::EyeScatter psf = eye::eye_scatter(kScattering.scatter);
    const vision::ImageAngles left = gpu_scene::angles_of(drive::channel_view(channels.screens[0], driver));
    for (const size_t channel : {1u, 2u})
        for (const glm::ivec2 at : {glm::ivec2(0, 48), {1, 3}, {30, 70}, {40, 95}}) {
            const VkExtent2D extent = seen.channels[channel].extent;
            double want = 0;
            for (int y = 0; y < int(kSide); ++y)
                for (int x = 0; x < int(kSide); ++x) {
                    const glm::dvec2 pixel = glm::dvec2(x, y) + 0.5;
                    const double light = double(shown.channels[0].scene[4 * size_t(y * int(kSide) + x)]);
                    const double theta =
                        light > 0 ? reference::degrees_apart(towards(channel, glm::dvec2(at) + 0.5), towards(0, pixel))
                                  : 0;
                    if (light > 0)
                        want += light * psf(theta) * reference::solid_angle(left, reference::direction_of(left, pixel));
                }
            EXPECT_NEAR(seen.channels[channel].retina[4 * (size_t(at.y) * extent.width + size_t(at.x))] / want, 1, 0.03)
                << channel << ": " << at.x << ", " << at.y;
        }
}

// Lamps, too: what the left screen shows of it counts there, and not as a lamp besides.
TEST(Channels, LampsOfOtherScreensCountOnce) {
    Rig rig(wall_scene(0, 20000, scene::Lamp::Kind::Spot));
    const Channels channels = turned_screens();
    const View driver = View::symmetric({1, 1}, 1, glm::mat4(1));
    const ChannelMosaic wall =
        rig.wall.render(rig.renderer, channels, kScattering, driver, rig.frame, 0, {.display = true, .retina = true});
    const glm::dvec3 lamp(-19 * std::tan(32 * kRadiansPerDegree), 0, -19);
    const double distance = glm::length(lamp), lux = 20000 / (distance * distance);
    const vision::EyeScatter psf = eye::eye_scatter(kScattering.scatter);
    const vision::ImageAngles middle = gpu_scene::angles_of(drive::channel_view(channels.screens[1], driver));
    for (const glm::ivec2 at : {glm::ivec2(0, 60), {60, 60}, {119, 10}}) {
        const double theta = reference::degrees_apart(lamp, reference::direction_of(middle, glm::dvec2(at) + 0.5));
        const double want = lux * psf(theta) * 1;
        EXPECT_NEAR(wall.channels[1].retina[4 * size_t(at.y * 120 + at.x) + 1] / want, 1, 0.04) << at.x;
    }
    EXPECT_TRUE(wall.channels[0].outside.empty());
    ASSERT_EQ(wall.channels[1].outside.size(), 1u);  // for the log
}

// One screen: the same picture and the same codes as without a file of screens, and the luminance of the scene.
TEST(Channels, OneScreenIsAView) {
    Rig rig(wall_scene(0.02f, 20000, scene::Lamp::Kind::Spot));
    Channels one;
    one.screens.push_back(three().screens[0]);
    const View driver = View::symmetric({1, 1}, 1, glm::mat4(1));
    const ChannelMosaic wall = rig.wall.render(rig.renderer, one, kScattering, driver, rig.frame, 0,
                                               {.display = true, .scene = true, .retina = true});
    const render::Frame alone = rig.renderer.render(kScattering, drive::channel_view(one.screens[0], driver), rig.frame,
                                                    0, {.display = true, .scene = true});
    EXPECT_EQ(wall.shown.scene, alone.scene);
    EXPECT_EQ(wall.channels[0].scene, alone.scene);
    EXPECT_NE(wall.channels[0].retina, alone.scene);
    EXPECT_EQ(wall.shown.display, alone.display);
}

// Needles are those of the one eye, which adapts and lives from frame to frame.
TEST(Channels, NeedlesMoveWithTheOneEye) {
    Rig rig(wall_scene(0.02f, 20000, scene::Lamp::Kind::Spot));
    render::RenderSettings settings = kScattering;
    settings.scatter.model = eye::ScatterSettings::Model::Temporal;
    const auto left = [&](float seconds) {
        return rig.wall
            .render(rig.renderer, three(), settings, View::symmetric({1, 1}, 1, glm::mat4(1)), rig.frame, seconds,
                    {.display = true, .retina = true})
            .channels.front();
    };
    const render::Frame first = left(0), later = left(0.4f), last = left(0.4f);
    EXPECT_GT(first.pupil, 2);
    EXPECT_NE(later.pupil, first.pupil);
    EXPECT_NE(last.pupil, later.pupil);
    EXPECT_NE(last.retina, later.retina);
    rig.wall.reset_adaptation();
    EXPECT_EQ(left(0).retina, first.retina);
}

TEST(Channels, TurnedScreensSeeWhereTheyLook) {
    const View driver = View::symmetric({1, 1}, 1, glm::mat4(1));
    const auto ahead = [&](double yaw, double pitch) {
        drive::ScreenChannel c{
            .name = "", .yaw = yaw, .pitch = pitch, .left = -0.1, .right = 0.1, .bottom = -0.1, .top = 0.1};
        return glm::vec3(glm::inverse(drive::channel_view(c, driver).world_to_view) * glm::vec4(0, 0, -1, 0));
    };
    EXPECT_LT(glm::distance(ahead(90 * kRadiansPerDegree, 0), glm::vec3(-1, 0, 0)), 1e-6);
    EXPECT_LT(glm::distance(ahead(0, 90 * kRadiansPerDegree), glm::vec3(0, 1, 0)), 1e-6);
    const drive::ScreenChannel rolled{
        .name = "", .roll = 90 * kRadiansPerDegree, .left = -0.1, .right = 0.1, .bottom = -0.1, .top = 0.1};
    // Rolled clockwise, what is up in the picture lies to the right.
    EXPECT_LT(glm::distance(
                  glm::vec3(glm::inverse(drive::channel_view(rolled, driver).world_to_view) * glm::vec4(0, 1, 0, 0)),
                  glm::vec3(1, 0, 0)),
              1e-6);
}

TEST(Channels, FilesAreReadOrRefused) {
    const std::string data = std::string(VESPER_SOURCE_DIR) + "/data/channels/";
    EXPECT_EQ(drive::read_channels(data + "one-screen.json").screens.size(), 1u);
    const Channels screens = drive::read_channels(data + "three-screens.json");
    EXPECT_EQ(screens.screens.size(), 3u);
    EXPECT_EQ(screens.gaze, 1u);
    const TempFolder folder;
    for (
        const char* bad :
        {"{}", R"({"version": 1, "channels": []})",
         R"({"version": 1, "gaze": "x", "channels": [{"name": "a", "size_px": [8, 8], "left_deg": -1, "right_deg": 1, "bottom_deg": -1, "top_deg": 1}]})",
         R"({"version": 1, "channels": [{"name": "a", "size_px": [8, 8], "left_deg": 1, "right_deg": -1, "bottom_deg": -1, "top_deg": 1}]})",
         R"({"version": 1, "channels": [{"name": "a", "size_px": [0, 8], "left_deg": -1, "right_deg": 1, "bottom_deg": -1, "top_deg": 1}]})"})
        EXPECT_THROW(drive::read_channels(folder.write("bad.json", bad)), Error) << bad;
    const std::string huge =
        R"({"name": "x", "size_px": [16384, 16384], "left_deg": -20, "right_deg": 20, "bottom_deg": -10, "top_deg": 10})";
    const std::string one =
        R"({"name": "x", "size_px": [8, 8], "left_deg": -1, "right_deg": 1, "bottom_deg": -1, "top_deg": 1})";
    EXPECT_THROW(
        drive::read_channels(folder.write("twice.json", R"({"version": 1, "channels": [)" + one + ", " + one + "]}")),
        Error);
    EXPECT_THROW(drive::read_channels(folder.write("huge.json", R"({"version": 1, "channels": [)" + huge + "]}")),
                 Error);
}

// 40 bytes a pixel: 2 GiB are 53,687,091 px in one process. Ranks share them; half a picture less is read.
TEST(Channels, OfOneProcessTakeAtMostTwoGibibytes) {
    const TempFolder folder;
    const auto complaint = [&](int screens, int width, int height, int of_each_rank) {
        nlohmann::json file = {{"version", 1}};
        for (int i = 0; i < screens; ++i)
            file["channels"].push_back({{"name", std::to_string(i)},
                                        {"size_px", {width, height}},
                                        {"yaw_deg", 10 * i - 150},
                                        {"left_deg", -4},
                                        {"right_deg", 4},
                                        {"bottom_deg", -4},
                                        {"top_deg", 4},
                                        {"rank", i / of_each_rank}});
        return complaint_of([&] { drive::read_channels(folder.write("wall.json", file.dump())); });
    };
    const std::string said = complaint(30, 2000, 2000, 30);
    EXPECT_TRUE(contains(said, "wall.json: /channels: have 120000000 px in one process, more than the 53687091 px"))
        << said;
    EXPECT_TRUE(contains(complaint(14, 2000, 2000, 14), "56000000 px"));
    EXPECT_EQ(complaint(13, 2000, 2000, 13), "");
    EXPECT_EQ(complaint(30, 2000, 2000, 10), "");
    EXPECT_TRUE(contains(complaint(1, 16384, 4096, 1), "67108864 px"));
}

// Two projectors side by side, so many degrees apart, each 40 wide.
std::string projectors(double apart, const std::string& left = "", const std::string& right = "") {
    const std::string edges = R"(, "left_deg": -20, "right_deg": 20, "bottom_deg": -10, "top_deg": 10)";
    return R"({"version": 1, "channels": [{"name": "l", "size_px": [24, 12], "yaw_deg": )" + std::to_string(apart) +
           edges + left + R"(}, {"name": "r", "size_px": [24, 12])" + edges + right + "}]}";
}

// What both show is an error, unless each is mapped onto its projector.
TEST(Channels, ThatOverlapNeedMaps) {
    const TempFolder folder;
    const auto read = [&](const std::string& text) { return drive::read_channels(folder.write("rig.json", text)); };
    folder.write("mesh.data", "2\n2 2\n-2 -1 0 0 1\n2 -1 1 0 1\n-2 1 0 1 1\n2 1 1 1 1\n");
    const std::string warp = R"(, "warp": "mesh.data")";
    for (const char* key : {"warp", "mask", "display"}) {
        const std::string said =
            complaint_of([&] { read(projectors(40, ", \"" + std::string(key) + "\": \"gone.x\"")); });
        EXPECT_TRUE(contains(said, "rig.json: /channels/0/" + std::string(key) + ": ")) << said;
        EXPECT_TRUE(contains(said, "gone.x: cannot be opened")) << said;
    }
    EXPECT_EQ(read(projectors(40)).screens.size(), 2u);
    EXPECT_EQ(read(projectors(180)).screens.size(), 2u);
    EXPECT_NE(complaint_of([&] { read(projectors(37)); }).find("/channels: channels l and r overlap: "),
              std::string::npos);
    EXPECT_NE(complaint_of([&] { read(projectors(37, warp)); }).find(" overlap: "), std::string::npos);
    EXPECT_NE(read(projectors(37, warp, warp)).screens[1].projection, nullptr);
    EXPECT_NE(complaint_of([&] { read(projectors(40, R"(, "mask": "none.png")")); }).find("none.png"),
              std::string::npos);
    EXPECT_NE(complaint_of([&] { read(projectors(40, R"(, "warp": "../mesh.data")")); }).find("/channels/0/warp"),
              std::string::npos);
}

// Each is shown by its display, mapped onto its projector; the eye's curve is for what all displays can show. A mesh
// that turns the picture over shows the last row first.
TEST(Channels, AreShownByTheirDisplaysAndProjectors) {
    Rig rig(wall_scene(3, 300, scene::Lamp::Kind::Point));
    Channels plain = three(), own = three();
    const View driver = View::symmetric({1, 1}, 1, glm::mat4(1));
    const std::string text = "2\n2 2\n-1 1 0 0 1\n1 1 1 0 1\n-1 -1 0 1 1\n1 -1 1 1 1\n";
    const vision::WarpMesh over =
        vision::parse_warp_mesh({reinterpret_cast<const uint8_t*>(text.data()), text.size()}, "m");
    const VkExtent2D extent = own.screens[0].extent;
    own.screens[0].projection = std::make_shared<const eye::Projection>(eye::projection_of(extent, extent, &over));
    const auto shown = [&](const Channels& channels, const vision::Display& display) {
        render::RenderSettings settings;
        settings.display = display;
        rig.wall.reset_adaptation();
        return rig.wall.render(rig.renderer, channels, settings, driver, rig.frame, 0, {.display = true});
    };
    const vision::Display usual;
    const ChannelMosaic as_is = shown(plain, usual), mapped = shown(own, usual);
    const size_t row = size_t{4} * extent.width;
    for (uint32_t y = 0; y < extent.height; ++y)
        for (size_t i = 0; i < row; ++i)
            ASSERT_NEAR(mapped.channels[0].display[y * row + i],
                        as_is.channels[0].display[(extent.height - 1 - y) * row + i], 1)
                << "the factors 1 and 1/255 of a code";
    EXPECT_EQ(mapped.channels[1].display, as_is.channels[1].display);

    // Half as bright, and twice as bright: codes of both are of the same luminance, where the curve is for the dimmer.
    vision::Display dim = usual, bright = usual;
    dim.black = bright.black = 0.1f, dim.ambient = bright.ambient = 0;
    dim.peak = 100, bright.peak = 200;
    own.screens[0].projection = nullptr;
    own.screens[0].display = dim, own.screens[1].display = bright, own.screens[2].display = dim;
    const ChannelMosaic both = shown(own, dim);
    plain.screens[1].display = dim;
    const ChannelMosaic of_dim = shown(plain, dim);
    EXPECT_EQ(both.channels[0].display, of_dim.channels[0].display);
    const auto luminance = [](const vision::Display& display, uint8_t code) {
        return vision::DisplayCurve(display).emitted(code / 255.0);
    };
    const size_t middle = 4 * (size_t{extent.height} / 2 * extent.width + extent.width / 2);
    const uint8_t dim_code = of_dim.channels[1].display[middle], bright_code = both.channels[1].display[middle];
    EXPECT_LT(bright_code, 0.8 * dim_code);
    EXPECT_NEAR(luminance(bright, bright_code) / luminance(dim, dim_code), 1, 0.08) << "half a code of each";

    own.screens[1].display->bits = 10;
    EXPECT_NE(complaint_of([&] { shown(own, dim); }).find("channel 0: its display has codes of 10 bits"),
              std::string::npos);
}

}  // namespace
}  // namespace vesper::test
