// Mean colours on the device against their reference. SPDX-License-Identifier: MIT
#include "passes/colours_reference.h"

#include <random>

#include "render/passes/colours.h"
#include "support/compare.h"
#include "support/texels.h"

namespace vesper::test::colours_test {
namespace {

TEST(Colours, AreMeansOfTheFinitePixelsOfTiles) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {65, 33}, {131, 67}}) {
        std::vector<glm::vec4> scene(size_t(extent.width) * extent.height);
        std::mt19937 random(extent.width);
        std::uniform_real_distribution<float> decades(-3, 5);
        for (size_t i = 0; i < scene.size(); ++i)
            scene[i] = {std::pow(10.0f, decades(random)), std::pow(10.0f, decades(random)), i % 5 ? 1.0f : -1.0f, 1};
        if (scene.size() > 9)
            scene[3].y = std::numeric_limits<float>::quiet_NaN(), scene[9].x = std::numeric_limits<float>::infinity();
        graph::FrameGraph graph;
        const render::Colours colours = render::add_colours(
            rig.frame(graph, extent), rig.image(graph, "scene", render::kSceneFormat, extent, scene));
        const graph::Resource kept = keep<glm::vec4>(graph, colours.tiles);
        rig.run(graph);
        const auto got = rig.got<glm::vec4>(kept);
        const auto want = reference::colour_tiles(std::span<const glm::vec4>(scene), extent.width, extent.height);
        ASSERT_EQ(got.size(), want.texels.size());
        // Sums of 1024 floats, row by row: 64 roundings at most.
        for (size_t i = 0; i < got.size(); ++i)
            for (int c = 0; c < 4; ++c)
                EXPECT_NEAR(got[i][c], want.texels[i][c], 1e-5 * std::abs(want.texels[i][c]) + 1e-6) << i;
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Colours, WhereTheyAreNotWantedThereIsNoPass) {
    PassRig rig;
    graph::FrameGraph graph;
    const render::FrameContext frame = rig.frame(graph, VkExtent2D{8, 8});
    const graph::Resource scene = graph.transient("scene", graph::image_shape(render::kSceneFormat, {8, 8}));
    EXPECT_EQ(render::add_colours(frame, scene, false).tiles, graph::Resource{});
    EXPECT_TRUE(graph.passes().empty());
}

}  // namespace
}  // namespace vesper::test::colours_test
