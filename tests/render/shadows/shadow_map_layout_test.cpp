// Layouts of shadow maps, and the frames that they are drawn in. SPDX-License-Identifier: MIT
#include "render/shadows/shadow_map_layout.h"

#include <cmath>

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "passes/shadows/draw_shadow_maps_reference.h"
#include "support/noise.h"

namespace vesper::test::shadow_map_layout_test {
namespace {

using render::ShadowMapLayout;

TEST(ShadowMapLayout, AMapLooksAlongItsLamp) {
    const glm::dmat4 node = glm::translate(glm::dmat4(1), glm::dvec3(1e6, 2, -5e6)) *
                            glm::mat4_cast(glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)))) *
                            glm::scale(glm::dmat4(1), glm::dvec3(2, -3, 0.5));  // mirrored
    const render::MapFrame frame = render::map_frame(node);
    const glm::dmat3 should_be_one = frame.rotation * glm::transpose(frame.rotation);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(should_be_one[i][j], i == j ? 1 : 0, 1e-12);
    EXPECT_NEAR(glm::determinant(frame.rotation), 1, 1e-12);
    const glm::dvec3 along = frame.rotation * -glm::normalize(glm::dvec3(node[2]));
    EXPECT_NEAR(along.z, 1, 1e-12);
    EXPECT_EQ(frame.position, glm::dvec3(node[3]));
    // A node that is squeezed flat still has a frame.
    EXPECT_NEAR(glm::determinant(render::map_frame(glm::dmat4(0)).rotation), 1, 1e-12);
}

TEST(ShadowMapLayout, TheShadersTurnIsThatOfTheFrame) {
    const glm::dmat4 node = glm::mat4_cast(glm::angleAxis(2.5, glm::normalize(glm::dvec3(-1, 0.3, 0.4))));
    const render::MapFrame frame = render::map_frame(node);
    gpu_scene::View view;
    view.world_to_view = glm::mat4_cast(glm::angleAxis(-1.1, glm::normalize(glm::dvec3(0.2, 1, -0.7))));
    const shared::ShadowMap map = render::shadow_map(
        {.side = 128, .hemispheres = 2, .zoom = 1.5f, .range = 1, .radius = 0.25f, .first = 640}, frame, view);
    const glm::dquat turn(double(map.rotation.w), double(map.rotation.x), double(map.rotation.y),
                          double(map.rotation.z));
    for (const glm::dvec3 world : {glm::dvec3(1, 0, 0), {0, 1, 0}, {0.3, -0.4, 0.8}}) {
        const glm::dvec3 in_view(view.world_to_view * glm::dvec4(world, 0));
        EXPECT_NEAR(glm::distance(turn * in_view, frame.rotation * world), 0, 1e-6);
    }
    EXPECT_EQ(map.first, 10);
    EXPECT_EQ(map.side, 128);
    EXPECT_EQ(map.zoom, -1.5f);
    EXPECT_EQ(map.radius, 0.25f);
}

// Every direction to a sphere falls into a quadrant that may see it; and most spheres are seen by few of them.
TEST(ShadowMapLayout, QuadrantsSeeAllOfASphere) {
    Noise noise(3);
    size_t held = 0, seen = 0, all = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const ShadowMapLayout layout{.side = 64,
                                     .hemispheres = 1,
                                     .zoom = trial % 3 == 0 ? 1.0f : 2.5f,
                                     .flat = trial % 5 == 0,
                                     .range = 100,
                                     .radius = 0,
                                     .first = 0};
        const auto direction = [&] {
            return glm::normalize(glm::dvec3{noise.normal(), noise.normal(), noise.normal()});  // {}: in this order
        };
        const double far = 1 + 20 * double(noise.fine());
        const glm::dvec3 centre = far * direction();
        const double radius = 0.3 + 1.5 * double(noise.fine());
        for (const glm::dvec2 signs : render::quadrants_of(layout)) {
            const bool may_see = render::may_see(double(layout.zoom), signs, centre, radius);
            seen += may_see ? 1 : 0, ++all;
            for (int k = 0; k < 100; ++k) {
                const glm::dvec3 p = centre + radius * direction();
                const glm::dvec2 texel = reference::map_texel(p, layout.side, double(layout.zoom), layout.flat);
                if (p.z < 0 || p.x * signs.x < 0 || p.y * signs.y < 0 ||
                    glm::any(glm::lessThan(texel, glm::dvec2(0))) ||
                    glm::any(glm::greaterThanEqual(texel, glm::dvec2(layout.side))))
                    continue;
                ++held;
                EXPECT_TRUE(may_see) << trial;
            }
        }
    }
    EXPECT_GT(held, 4000u);
    EXPECT_LT(seen, all / 2);
}

TEST(ShadowMapLayout, SidesFallWithDistanceAndFillTheMemory) {
    std::vector<ShadowMapLayout> layouts(
        200, {.side = 0, .hemispheres = 1, .zoom = 1, .range = 1000, .radius = 0, .first = 0});
    layouts[7].hemispheres = 2;
    layouts[9].range = 0;  // does not shine
    std::vector<double> distances;
    for (int i = 0; i < 200; ++i) distances.push_back(5.0 + 5.0 * i);
    for (const uint64_t most : {uint64_t(48) << 20, uint64_t(4) << 20, uint64_t(201) << 12}) {
        const double scale = render::choose_sides(layouts, distances, 8, most);
        EXPECT_LE(scale, 8);
        uint64_t texels = 0;
        for (size_t i = 0; i < layouts.size(); ++i) {
            texels += layouts[i].texels();
            if (i == 9) {
                EXPECT_EQ(layouts[i].side, 0u);
                continue;
            }
            EXPECT_TRUE(std::has_single_bit(layouts[i].side));
            EXPECT_GE(layouts[i].side, 64u);
            EXPECT_LE(layouts[i].side, 2048u);
            EXPECT_TRUE(i <= 10 || layouts[i].side <= layouts[i - 1].side);
            const double side = std::exp2(scale) * std::sqrt(1000 / distances[i]);
            EXPECT_GE(double(layouts[i].side), std::min(side / 1.415, 2048.0));
            EXPECT_LE(double(layouts[i].side), std::max(side * 1.415, 64.0));
        }
        EXPECT_LE(texels, most);
        if (scale < 8) {
            std::vector<ShadowMapLayout> more = layouts;
            render::choose_sides(more, distances, scale + 0.125, ~uint64_t{0});
            texels = 0;
            for (const ShadowMapLayout& layout : more) texels += layout.texels();
            EXPECT_GT(texels, most) << "a step more would not fit";
        }
    }
    EXPECT_EQ(render::least_texels(layouts), uint64_t(200) << 12);
    render::choose_sides(layouts, distances, 8, 199 << 12);
    EXPECT_EQ(layouts[3].side, render::kLeastMapSide);
    // However far they shine.
    for (const float range : {1e19f, std::numeric_limits<float>::infinity()}) {
        std::vector<ShadowMapLayout> bright = layouts;
        for (ShadowMapLayout& layout : bright) layout.range = range;
        render::choose_sides(bright, distances, 8, uint64_t(250) << 12);
        uint64_t texels = 0;
        for (const ShadowMapLayout& layout : bright) texels += layout.texels();
        EXPECT_LE(texels, uint64_t(250) << 12);
    }
    // A beam's map is as much smaller as it holds less of the hemisphere.
    layouts.resize(2), layouts[0].zoom = 8, distances = {10, 10};
    render::choose_sides(layouts, distances, 6, uint64_t(1) << 20);
    EXPECT_EQ(layouts[0].side * 8, layouts[1].side);
    // That of a lamp that moves has half the side.
    layouts[1].moves = true;
    render::choose_sides(layouts, distances, 6, uint64_t(1) << 20);
    EXPECT_EQ(layouts[0].side * 4, layouts[1].side);
    // A lamp that is nowhere has the least map.
    distances[0] = std::numeric_limits<double>::quiet_NaN();
    render::choose_sides(layouts, distances, 6, uint64_t(1) << 20);
    EXPECT_EQ(layouts[0].side, render::kLeastMapSide);
}

// A quarter of the memory halves the sides.
TEST(ShadowMapLayout, TheScaleOfASceneFollowsFromTheMemory) {
    render::ShadowMapPlan plan;
    for (int i = 0; i < 100; ++i) {
        plan.layouts.push_back({.side = 0, .hemispheres = 1, .zoom = 1, .range = 1000, .radius = 0, .first = 0});
        plan.places.emplace_back(30.0 * i, 5, 0);
    }
    const double scale = render::scene_scale(plan, uint64_t(16) << 20);
    EXPECT_NEAR(render::scene_scale(plan, uint64_t(4) << 20), scale - 1, 0.25);
    EXPECT_GT(render::scene_scale(plan, uint64_t(99) << 12), scale) << "they fit only where some do not shine";
}

}  // namespace
}  // namespace vesper::test::shadow_map_layout_test
