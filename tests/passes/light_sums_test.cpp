// Sums of light on the device against their reference. SPDX-License-Identifier: MIT
#include "render/passes/light_sums.h"

#include "passes/light_sums_reference.h"
#include "support/noise.h"
#include "support/texels.h"

namespace vesper::test::light_sums_test {
namespace {

gpu_scene::View looking(VkExtent2D extent) {
    gpu_scene::View view{.extent = extent};
    view.tangent_low = {-0.9f, -0.4f}, view.tangent_high = {0.5f, 0.6f};
    return view;
}

/// Coloured luminances over six decades; every 13th pixel has something that is not finite.
std::vector<glm::vec4> picture(VkExtent2D extent) {
    Noise random(extent.width);
    std::vector<glm::vec4> pixels;
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        const float light = std::pow(10.0f, 6 * random.unit() - 2);
        pixels.emplace_back(light, light * random.unit(), light * random.unit(), 1);
        if (i % 13 == 5) pixels.back()[i % 3] = i % 2 ? INFINITY : std::nanf("");
    }
    return pixels;
}

std::vector<glm::vec4> light_of(PassRig& rig, VkExtent2D extent, const std::vector<glm::vec4>& pixels,
                                const std::vector<uint32_t>& nodes) {
    graph::FrameGraph graph;
    const graph::Resource image = rig.image(graph, "picture", render::kSceneFormat, extent, pixels);
    const graph::Resource kept = rig.want<glm::vec4>(
        graph, render::add_light_sums(rig.frame(graph, looking(extent)), image, nodes), nodes.size());
    rig.run(graph);
    return rig.got<glm::vec4>(kept);
}

// All nodes of all levels, in another order than theirs.
TEST(LightSums, MatchTheReferenceAtEverySize) {
    PassRig rig;
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {2, 9}, {64, 1}, {131, 67}}) {
        const std::vector<glm::vec4> pixels = picture(extent);
        const reference::LightSums want(gpu_scene::angles_of(looking(extent)), {&pixels[0].x, 4 * pixels.size()});
        std::vector<uint32_t> nodes(want.nodes().first.back());
        for (size_t i = 0; i < nodes.size(); ++i) nodes[i] = uint32_t(nodes.size() - 1 - i);
        const std::vector<glm::vec4> got = light_of(rig, extent, pixels, nodes);
        ASSERT_EQ(got.size(), nodes.size());
        for (size_t i = 0; i < nodes.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const double sum = want.at(nodes[i])[c];
                // 2e-6: the light of a pixel is good to some roundings, and each level sums nine.
                ASSERT_NEAR(got[i][c], sum, 2e-6 * sum)
                    << extent.width << " x " << extent.height << ", node " << nodes[i];
            }
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(LightSums, AreTheSameFromRunToRun) {
    PassRig rig;
    const VkExtent2D extent{97, 61};
    const std::vector<uint32_t> nodes{0, 5, 97 * 61, 97 * 61 + 40};
    const std::vector<glm::vec4> first = light_of(rig, extent, picture(extent), nodes);
    EXPECT_EQ(first, light_of(rig, extent, picture(extent), nodes));
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::light_sums_test
