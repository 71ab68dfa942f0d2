// Levels of maps of directional lamps about the eye. SPDX-License-Identifier: MIT
#include "render/shadows/clipmap_layout.h"

#include <gtest/gtest.h>

#include "support/noise.h"

namespace vesper::test::clipmap_layout_test {
namespace {

TEST(Clipmaps, ManyLampsHaveSmallerMapsInTheSameMemory) {
    EXPECT_EQ(render::clipmap_plan(0).side, 0u);
    EXPECT_EQ(render::clipmap_plan(1).side, 2048u);
    EXPECT_EQ(render::clipmap_plan(4).side, 1024u);
    for (uint32_t lamps = 1; lamps <= 64; ++lamps) {
        const render::ClipmapPlan plan = render::clipmap_plan(lamps);
        EXPECT_GE(plan.side, render::kLeastClipmapSide) << lamps;
        EXPECT_LE(plan.texels(), render::kMostClipmapTexels) << lamps;
    }
    EXPECT_EQ(render::clipmap_plan(65).side, 0u) << "which is refused";
}

// A level moves in steps and holds what is near the eye, far from the origin too.
TEST(Clipmaps, LevelsMoveInSteps) {
    Noise noise(4);
    for (int trial = 0; trial < 200; ++trial) {
        const glm::dmat3 rotation =
            render::map_frame(glm::dmat4(glm::dmat3(noise.facing(0.1), noise.facing(0.2), noise.facing(0.3)))).rotation;
        const glm::dvec3 eye = 1e5 * noise.facing(0.1);
        for (uint32_t level = 0; level < 8; ++level) {
            const double step = double(shared::kLevelStep) * render::level_half_width(level);
            const glm::dvec3 middle = render::level_middle(rotation, eye, level), off = middle - rotation * eye;
            for (int axis = 0; axis < 3; ++axis) EXPECT_LE(std::abs(off[axis]), step / 2 * (1 + 1e-9));
            const glm::dvec3 again = render::level_middle(rotation, eye + 1e-6 * noise.facing(0.1), level);
            EXPECT_TRUE(again == middle || glm::distance(again, middle) > 0.9 * step);
        }
    }
}

TEST(Clipmaps, AShaderTurnsAndMovesPointsAsTheHost) {
    const render::ClipmapPlan plan{.lamps = 2, .side = 256};
    gpu_scene::View view;
    view.world_to_view =
        glm::translate(glm::mat4_cast(glm::angleAxis(0.5, glm::dvec3(0, 1, 0))), glm::dvec3(-1e4, 3, 7));
    const glm::dmat3 rotation =
        render::map_frame(glm::mat4_cast(glm::angleAxis(-1.1, glm::normalize(glm::dvec3(1, 0.1, 0.3))))).rotation;
    const shared::Clipmap map = render::clipmap(plan, 1, rotation, 0.2, view);
    EXPECT_EQ(map.first, 8.0f * 256 * 256 / shared::kMapUnit);
    EXPECT_NEAR(double(map.radius), std::tan(0.1), 1e-7);
    const glm::dvec3 in_view(2, -1, -30), world(glm::inverse(view.world_to_view) * glm::dvec4(in_view, 1));
    const glm::dquat turn(double(map.rotation.w), double(map.rotation.x), double(map.rotation.y),
                          double(map.rotation.z));
    const glm::dvec3 want = rotation * world - render::level_middle(rotation, gpu_scene::eye_of(view), 2);
    EXPECT_LT(glm::distance(turn * in_view - glm::dvec3(map.middle[2]), want), 1e-5);
}

}  // namespace
}  // namespace vesper::test::clipmap_layout_test
