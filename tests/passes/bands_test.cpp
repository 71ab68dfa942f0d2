// Bands of contrast on the device against their reference. SPDX-License-Identifier: MIT
#include "passes/bands_reference.h"

#include "render/passes/bands.h"
#include "support/compare.h"
#include "support/pass_rig.h"
#include "support/texels.h"
#include "support/tones.h"

namespace vesper::test::bands_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

shared::ToneParameters display_parameters() {
    shared::ToneParameters p{};
    p.cone_break = 1.9176f, p.rod_break = -1.205f, p.viewer_sigma = 130, p.viewer_step = 0.012f;
    return p;
}

std::vector<glm::vec4> bands(PassRig& rig, VkExtent2D extent, const std::vector<glm::vec4>& scene, uint32_t top,
                             uint32_t tone, const shared::ToneCurve& curve) {
    graph::FrameGraph graph;
    const graph::Resource image = rig.image(graph, "scene", render::kSceneFormat, extent, scene);
    const render::Pyramid pyramid = render::add_pyramid(rig.frame(graph, extent), image);
    const graph::Resource table = graph.upload("curve", std::vector{curve}, VK_FORMAT_R32G32B32A32_SFLOAT);
    const graph::Resource kept =
        keep<glm::vec4>(graph, render::add_bands(rig.frame(graph, extent), image, pyramid, top, table,
                                                 {.tone = tone, .parameters = display_parameters()}));
    rig.run(graph);
    return rig.got<glm::vec4>(kept);
}

void expect_reference(PassRig& rig, VkExtent2D extent, const std::vector<glm::vec4>& scene, uint32_t top,
                      uint32_t tone) {
    const shared::ToneCurve curve = crooked_curve({});
    const auto levels = reference::pyramid(std::span<const glm::vec4>(scene), extent.width, extent.height);
    if (top > levels.size()) return;
    std::vector<double> luminance;
    for (const glm::vec4& p : scene) luminance.push_back(reference::luminance(glm::dvec3(p)));
    const auto want =
        reference::bands(luminance, extent.width, extent.height, levels, top, curve, display_parameters());
    const auto got = bands(rig, extent, scene, top, tone, curve);
    for (size_t i = 0; i < got.size(); ++i) {
        const glm::dvec3 rgb(scene[i]);
        if (!reference::finite(rgb)) {
            EXPECT_FALSE(std::isfinite(reference::luminance(glm::dvec3(got[i])))) << i;
            continue;
        }
        // Powers, logarithms and exponentials as exactly as Vulkan asks for move each of what is added up, ln
        // luminances, by some 1e-6.
        const glm::dvec3 expected = reference::banded(rgb, std::exp(want.shown[i]), tone, curve);
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(got[i][c], expected[c], (2e-5 + 1e-5 * want.terms[i]) * std::abs(expected[c]))
                << extent.width << " x " << extent.height << " top " << top << " pixel " << i;
    }
}

TEST(Bands, MatchTheReferenceAtEverySize) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {1, 9}, {7, 5}, {65, 3}, {131, 67}})
        for (const uint32_t top : {1u, 2u, 5u})
            for (const uint32_t tone :
                 {shared::kToneCurve, shared::kToneCurve | shared::kToneColourLoss | shared::kTonePurkinje})
                expect_reference(rig, extent, night_pixels(extent, extent.width, -4, 4), top, tone);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Bands, WhatIsNotFiniteStaysAloneAndSo) {
    PassRig rig;
    const VkExtent2D extent{21, 13};
    auto scene = night_pixels(extent, 3, -2, 3);
    scene[40] = {kNan, 1, 1, 1}, scene[41] = {1, std::numeric_limits<float>::infinity(), 1, 1},
    scene[60] = {-4, -4, -4, 1};
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            scene[size_t(y) * 21 + size_t(x)] = glm::vec4(kNan);  // whole texels of three levels
    for (const uint32_t top : {1u, 3u, 4u}) expect_reference(rig, extent, scene, top, shared::kToneCurve);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Bands, WhereTheyAreNotOnThereIsNoPass) {
    PassRig rig;
    graph::FrameGraph graph;
    const render::FrameContext frame = rig.frame(graph, VkExtent2D{8, 8});
    const graph::Resource scene = graph.transient("scene", graph::image_shape(render::kSceneFormat, {8, 8}));
    EXPECT_EQ(render::add_bands(frame, scene, {}, 1, {}, {.on = false}), scene);
    EXPECT_TRUE(graph.passes().empty());
}

}  // namespace
}  // namespace vesper::test::bands_test
