// Light scattered in the eye on the device against its reference. SPDX-License-Identifier: MIT
#include "passes/eye_scatter_reference.h"

#include <random>

#include "render/passes/eye_scatter.h"
#include "support/compare.h"
#include "support/texels.h"
#include "support/tones.h"

namespace vesper::test::eye_scatter_test {
namespace {

using glm::dvec2, glm::dvec3, glm::ivec2;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

gpu_scene::View view_of(VkExtent2D extent) { return gpu_scene::View::symmetric(extent, 0.6435f, glm::mat4(1)); }

std::vector<glm::vec4> seen(PassRig& rig, const std::vector<glm::vec4>& pixels, const eye::GpuScatter& fit,
                            const std::vector<eye::OffscreenLamp>& lamps,
                            const vision::OffscreenLight* beyond = nullptr) {
    graph::FrameGraph graph;
    const VkExtent2D extent{uint32_t(fit.image().width), uint32_t(fit.image().height)};
    const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, extent, pixels);
    const graph::Resource kept =
        keep<glm::vec4>(graph, render::add_eye_scatter(rig.frame(graph, extent), scene, {&fit, lamps, beyond}));
    rig.run(graph);
    return rig.got<glm::vec4>(kept);
}

/// Beside the picture, above it, just outside a corner, far away, and behind.
std::vector<eye::OffscreenLamp> some_lamps(const vision::ImageAngles& image) {
    const auto towards = [&](dvec2 pixels) { return reference::direction_of(image, pixels); };
    const double w = image.width, h = image.height;
    return {{towards({-2.5, h / 3}), {3, 2, 1}},
            {towards({w / 2, -0.3 * h}), dvec3(10)},
            {towards({w + 1, h + 2}), {0.2, 0.3, 0.5}},
            {towards({6 * w, h / 2}), {1, 2, 3}},
            {glm::normalize(dvec3(1, 0, 0.2)), dvec3(5)}};
}

/// Light from beyond, of as many decades as a night has, wherever there may be some: not in the outermost texels of a
/// margin.
vision::OffscreenLight some_light(const vision::ImageAngles& image, uint32_t seed) {
    vision::OffscreenLight beyond;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> exponent(-4, 4);
    const auto fill = [&](ivec2 size) {
        std::vector<glm::vec4> texels;
        for (int i = 0; i < size.x * size.y; ++i)
            texels.push_back(glm::vec4(std::pow(10.0f, exponent(random)) * glm::vec3(1, 0.8f, 0.5f), 0));
        return texels;
    };
    const auto margin = [&](ivec2 size) {
        std::vector<glm::vec4> texels = fill(size);
        for (int i = 0; i < size.x * size.y; ++i)
            if (const ivec2 at(i % size.x, i / size.x);
                at.x == 0 || at.y == 0 || at.x == size.x - 1 || at.y == size.y - 1)
                texels[size_t(i)] = glm::vec4(0);
        return texels;
    };
    for (int l = 0; l <= vision::scatter_levels(image); ++l)
        beyond.levels.push_back(l < 2 ? std::vector<glm::vec4>{}
                                      : margin(vision::scatter_size(image, l) + 2 * vision::kScatterMargin));
    beyond.veil = fill(vision::scatter_size(image, vision::scatter_levels(image)) + 2 * vision::kScatterReach);
    return beyond;
}

void expect_reference(PassRig& rig, VkExtent2D extent, std::vector<glm::vec4> pixels, bool lamps, bool others = false) {
    SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
    const eye::ScatterSettings settings;
    const vision::ImageAngles image = gpu_scene::angles_of(view_of(extent));
    const eye::GpuScatter resident(rig.device(), settings, image);
    const vision::ScatterFit fit =
        vision::fit_scatter(eye::eye_scatter(settings), image, eye::scatter_down_strip(rig.device()));
    const std::vector<eye::OffscreenLamp> outside = lamps ? some_lamps(image) : std::vector<eye::OffscreenLamp>{};

    reference::Plane scene({image.width, image.height});
    for (size_t i = 0; i < pixels.size(); ++i) scene.texels[i] = dvec3(pixels[i]);
    std::vector<std::vector<glm::vec4>> lists(size_t(fit.levels) + 1);
    for (int l = 1; l <= fit.levels; ++l) lists[size_t(l)] = resident.lamps_of(l, outside);
    const vision::OffscreenLight beyond = others ? some_light(image, extent.width) : vision::OffscreenLight{};
    const auto want = reference::scatter(scene, fit, lists, resident.far_veil(outside), beyond);
    const auto got = seen(rig, pixels, resident, outside, others ? &beyond : nullptr);

    Picture a(extent.width, extent.height, 3), b = a;
    for (size_t i = 0; i < got.size(); ++i)
        for (size_t c = 0; c < 3; ++c)
            a.values[3 * i + c] = got[i][int(c)], b.values[3 * i + c] = want.texels[i][int(c)];
    // 2e-5: sums of some hundred floats of one sign, over seven levels. Negative weights of some corners take a
    // hundredth of what others give.
    EXPECT_TRUE(same_light("seen", a, b, {2e-5, 1e-6}));
}

TEST(EyeScatter, MatchesTheReferenceAtEverySize) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {2, 9}, {65, 33}, {131, 67}, {300, 190}})
        for (bool lamps : {false, true})  // lamps beside a dark picture, where they count
            expect_reference(rig, extent, night_pixels(extent, extent.width, -4, lamps ? -1 : 8), lamps);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(EyeScatter, WhatIsNotFiniteStaysAndScattersNothing) {
    PassRig rig;
    const VkExtent2D extent{37, 22};
    auto pixels = night_pixels(extent, 3);
    for (size_t i = 0; i < pixels.size(); i += 7) pixels[i][int(i % 3)] = i % 2 ? kNan : kInf;
    pixels[5].y = -kInf;
    expect_reference(rig, extent, pixels, true);
    EXPECT_EQ(rig.complaints(), "");
}

// What other pictures of the eye have comes in at every level from the second on, and at the top.
TEST(EyeScatter, LightOfOthersComesInFromBeyond) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {2, 9}, {65, 33}, {131, 67}, {300, 190}})
        for (bool lamps : {false, true})
            expect_reference(rig, extent, night_pixels(extent, extent.width, -4, -1), lamps, true);
    const VkExtent2D extent{131, 67};
    auto pixels = night_pixels(extent, 3);
    for (size_t i = 0; i < pixels.size(); i += 7) pixels[i][int(i % 3)] = i % 2 ? kNan : kInf;
    expect_reference(rig, extent, pixels, true, true);
    EXPECT_EQ(rig.complaints(), "");
}

// 1e8 cd/m^2 in one pixel must leave 1e-3 cd/m^2 far away exact: nothing here adds numbers of other signs.
TEST(EyeScatter, AHeadlampDoesNotDrownTheDark) {
    PassRig rig;
    const VkExtent2D extent{300, 190};
    std::vector<glm::vec4> pixels(size_t(extent.width) * extent.height, glm::vec4(1e-3f, 1e-3f, 1e-3f, 1));
    pixels[size_t(95) * 300 + 150] = glm::vec4(1e8f, 1e8f, 1e8f, 1);
    expect_reference(rig, extent, pixels, false);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(EyeScatter, RunsAreAlikeToTheLastBit) {
    PassRig rig;
    const VkExtent2D extent{131, 67};
    const eye::GpuScatter fit(rig.device(), {}, gpu_scene::angles_of(view_of(extent)));
    const auto pixels = night_pixels(extent, 8);
    EXPECT_EQ(seen(rig, pixels, fit, some_lamps(fit.image())), seen(rig, pixels, fit, some_lamps(fit.image())));
}

// A lamp on its way out of the picture: outside it, the veil goes on where it stopped inside.
TEST(EyeScatter, LampsOutsideGoOnWhereThoseInsideEnd) {
    PassRig rig;
    const VkExtent2D extent{300, 190};
    const vision::ImageAngles image = gpu_scene::angles_of(view_of(extent));
    const eye::GpuScatter fit(rig.device(), {}, image);
    const vision::EyeScatter psf = eye::eye_scatter({});
    const std::vector<glm::vec4> dark(size_t(extent.width) * extent.height, glm::vec4(0));
    for (double beyond : {-30.5, -3.5, 1.5, 6.5, 12.5, 25.5, 60.5, 111.5, 300.5, 900.5}) {
        const dvec3 direction = reference::direction_of(image, {-beyond, 80.5});
        std::vector<glm::vec4> pixels = dark;
        std::vector<eye::OffscreenLamp> lamps;
        if (beyond < 0)
            pixels[size_t(80 * 300 - beyond)] = glm::vec4(float(1 / reference::solid_angle(image, direction)));
        else
            lamps.push_back({direction, dvec3(1)});
        const auto got = seen(rig, pixels, fit, lamps);
        double squares = 0;
        int count = 0;
        for (int y = 3; y < 190; y += 6)
            for (int x = 3; x < 300; x += 6) {
                const double theta =
                    reference::degrees_apart(direction, reference::direction_of(image, dvec2(x, y) + 0.5));
                if (theta < 0.6) continue;  // 3 pixels
                const double error = got[size_t(y * 300 + x)].g / psf(theta) - 1;
                EXPECT_LT(std::abs(error), 0.2) << beyond << " px outside, at " << x << ", " << y;
                squares += error * error, ++count;
            }
        EXPECT_LT(std::sqrt(squares / count), 0.07) << beyond << " px outside";
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(EyeScatter, WithoutAFitThereIsNoPass) {
    PassRig rig;
    graph::FrameGraph graph;
    const render::FrameContext frame = rig.frame(graph, VkExtent2D{8, 8});
    const graph::Resource scene = graph.transient("scene", graph::image_shape(render::kSceneFormat, {8, 8}));
    EXPECT_EQ(render::add_eye_scatter(frame, scene, {}), scene);
    EXPECT_TRUE(graph.passes().empty());
}

}  // namespace
}  // namespace vesper::test::eye_scatter_test
