// Loss of acuity on the device against its reference. SPDX-License-Identifier: MIT
#include "passes/acuity_reference.h"

#include <random>

#include "render/passes/acuity.h"
#include "support/compare.h"
#include "support/texels.h"
#include "support/tones.h"

namespace vesper::test::acuity_test {
namespace {

std::vector<glm::vec4> seen(PassRig& rig, const std::vector<glm::vec4>& pixels, const gpu_scene::View& view,
                            uint32_t foveal_level) {
    graph::FrameGraph graph;
    const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, view.extent, pixels);
    const render::Pyramid pyramid = render::add_pyramid(rig.frame(graph, view), scene);
    const graph::Resource kept =
        keep<glm::vec4>(graph, render::add_acuity(rig.frame(graph, view), scene, pyramid, foveal_level));
    rig.run(graph);
    return rig.got<glm::vec4>(kept);
}

TEST(Acuity, MatchesTheReference) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {65, 33}, {131, 67}})
        for (float degrees : {0.3f, 2.0f}) {
            auto pixels = night_pixels(extent, extent.width, -4, 1);
            if (pixels.size() > 20) pixels[9].x = std::numeric_limits<float>::quiet_NaN();
            const gpu_scene::View view =
                gpu_scene::View::symmetric(extent, degrees * float(extent.height) / 33 / 57.2958f, glm::mat4(1));
            const auto levels = reference::pyramid(std::span<const glm::vec4>(pixels), extent.width, extent.height);
            const uint32_t foveal = std::min(4u, uint32_t(levels.size()));
            const auto got = seen(rig, pixels, view, foveal);
            Picture got_light(extent.width, extent.height, 3), want = got_light;
            for (uint32_t y = 0; y < extent.height; ++y)
                for (uint32_t x = 0; x < extent.width; ++x) {
                    const size_t i = size_t(y) * extent.width + x;
                    const glm::dvec3 w =
                        reference::seen(glm::dvec3(pixels[i]), x, y, levels, foveal, 1 / view.degrees_per_pixel());
                    for (uint32_t c = 0; c < 3; ++c)
                        got_light.at(x, y, c) = got[i][int(c)], want.at(x, y, c) = w[int(c)];
                }
            // 1e-4: the level is a logarithm of an arc tangent of a logarithm, in float, times differences between
            // levels.
            EXPECT_TRUE(same_light("seen", got_light, want, {1e-4, 0.1}));
        }
    EXPECT_EQ(rig.complaints(), "");
}

// tone-mapping.md, section 3: 5.31 cycles/degree at 0.01 cd/m^2. At 32 px a degree that is sqrt(2) * 32 / 5.31 = 8.5
// px: a grating of 4 px is gone, one of 128 px is not; in daylight both stay.
TEST(Acuity, WhatIsTooFineInTheDarkIsGone) {
    PassRig rig;
    const VkExtent2D extent{256, 64};
    const gpu_scene::View view = gpu_scene::View::symmetric(extent, 2 / 57.2958f, glm::mat4(1));  // 32 px a degree
    const auto contrast = [&](double mean, uint32_t period) {
        std::vector<glm::vec4> pixels;
        for (uint32_t i = 0; i < extent.width * extent.height; ++i)
            pixels.emplace_back(glm::vec3(float(mean * (i % extent.width % period < period / 2 ? 1.5 : 0.5))), 1);
        const auto got = seen(rig, pixels, view, 5);
        float low = 1e9f, high = 0;
        for (uint32_t x = 64; x < 192; ++x)
            low = std::min(low, got[32 * 256 + x].x), high = std::max(high, got[32 * 256 + x].x);
        return (high - low) / (high + low);
    };
    EXPECT_LT(contrast(0.01, 4), 0.01);
    EXPECT_GT(contrast(0.01, 128), 0.45);
    EXPECT_NEAR(contrast(100, 4), 0.5, 1e-5);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Acuity, WithoutLossThereIsNoPass) {
    PassRig rig;
    graph::FrameGraph graph;
    const render::FrameContext frame = rig.frame(graph, VkExtent2D{8, 8});
    const graph::Resource scene = graph.transient("scene", graph::image_shape(render::kSceneFormat, {8, 8}));
    EXPECT_EQ(render::add_acuity(frame, scene, {}, 1, false), scene);
    EXPECT_TRUE(graph.passes().empty());
}

}  // namespace
}  // namespace vesper::test::acuity_test
