// Classes of blocks and the polynomials that stand for smooth lamps, in double. SPDX-License-Identifier: MIT
#include "passes/blocks_reference.h"

#include <gtest/gtest.h>

namespace vesper::reference::blocks_reference_test {
namespace {

SurfaceTexel texel(double metallic, double roughness, dvec3 normal = {0, 1, 0}, double depth = 10) {
    return {dvec4(0.5, 0.5, 0.5, metallic), dvec4(octahedral_encode(normal), depth, roughness), dvec3(0)};
}

TEST(BlocksReference, ThePolynomialMeetsItsNodesAndEveryQuadratic) {
    const Block block{{16, 8}, {}, {}};
    const OfPlace quadratic = [](dvec2 p) {
        return 3 + p.x - 2 * p.y + 0.5 * p.x * p.x + p.x * p.y - p.y * p.y + 0.1 * p.x * p.x * p.y * p.y;
    };
    for (const dvec2 place : {dvec2(16.5, 8.5), dvec2(20, 12), dvec2(23.5, 15.5), dvec2(17.3, 14.9)})
        EXPECT_NEAR(polynomial(block, quadratic, place), quadratic(place), 1e-9 * std::abs(quadratic(place)));
    EXPECT_LT(extremes_of(block, [&](dvec2 p) { return 1e6 + quadratic(p); }).error, 1e-6);
    const OfPlace exponential = [](dvec2 p) { return std::exp(p.x + p.y); };
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(polynomial(block, exponential, node(block, i, j)) / exponential(node(block, i, j)), 1, 1e-12);
}

// t (t - 1) (t - 2) is zero at the nodes 0, 1, 2; at 2/7 and 12/7 it is 120/343 and -120/343.
TEST(BlocksReference, ExtremesAreOfNodesAndTheErrorBetweenThem) {
    const Block block{{0, 0}, {}, {}};
    const OfPlace cubic = [](dvec2 p) {
        const double t = (p.x - 0.5) / 3.5;
        return 2 + t * (t - 1) * (t - 2);
    };
    const Extremes found = extremes_of(block, cubic);
    EXPECT_NEAR(found.error, 120 / 343.0, 1e-12);
    EXPECT_NEAR(found.least, 2 - 120 / 343.0, 1e-12);
}

TEST(BlocksReference, ABlockIsWhatIsDrawnInIt) {
    const auto block = [](std::vector<SurfaceTexel> texels) { return Block{{0, 0}, {}, std::move(texels)}; };
    EXPECT_EQ(class_of(block({}), false), shared::kClassEmpty);
    EXPECT_EQ(class_of(block({texel(0, 1)}), false), shared::kClassMatt);
    EXPECT_EQ(class_of(block({texel(0, 1)}), true), shared::kClassMattListed);
    EXPECT_EQ(class_of(block({texel(0, 1), texel(-2, 0.2)}), false), shared::kClassPaved);
    EXPECT_EQ(class_of(block({texel(-1, 0.2)}), true), shared::kClassPavedListed);
    EXPECT_EQ(class_of(block({texel(0, 1), texel(0, 0.9)}), false), shared::kClassGlossy);
    EXPECT_EQ(class_of(block({texel(0.5, 1)}), true), shared::kClassGlossy);
    EXPECT_EQ(class_of(block({texel(-1, 0.2), texel(0, 0.9)}), true), shared::kClassGlossyPaved);
    EXPECT_EQ(class_of(block({texel(-1, 0.2), texel(shared::kRetroCode, 1)}), true), shared::kClassRetro);
}

TEST(BlocksReference, APlaneHasOneNormalAndOneHeight) {
    shared::ClusterGrid grid{};
    grid.ray_scale = {0.01f, -0.01f}, grid.ray_offset = {-0.5f, 0.2f};
    const auto road = [&](double lean, double lift) {  // 1.2 m under the eye; its last pixel differs
        Block block{{40, 40}, {}, {}};
        for (uint32_t y = 40; y < 48; ++y)
            for (uint32_t x = 40; x < 48; ++x) {
                const dvec3 ray = view_position(grid, dvec2(x, y) + 0.5, 1);
                const bool last = block.pixels.size() == 63;
                block.pixels.emplace_back(x, y);
                block.texels.push_back(
                    texel(0, 1, glm::normalize(dvec3(last ? lean : 0, 1, 0)), -1.2 / ray.y * (last ? 1 + lift : 1)));
            }
        return plane_of(block, grid);
    };
    ASSERT_TRUE(road(0, 0));
    EXPECT_NEAR(road(0, 0)->away, -1.2, 1e-12);
    EXPECT_TRUE(road(1e-4, 0));
    EXPECT_FALSE(road(1e-3, 0));
    EXPECT_FALSE(road(0, 0.01));
}

// 1,000 cd straight above at 5 m: 40 lx; at an angle I cos^3 / h^2.
TEST(BlocksReference, LightOnAPlaneIsTheInverseSquareLaw) {
    shared::ClusterGrid grid{};
    grid.ray_scale = {1, -1}, grid.ray_offset = {0, 0};
    const shared::Lamp lamp{{0, 4, -1.2f}, 1000, {0, -1, 0}, 0, {1, 1, 1}, 1};
    const BlockPlane road{{0, 1, 0}, -1.0, 0};
    EXPECT_NEAR(light_on_plane(road, grid, lamp, LampKind::Cone, {0, 1 / 1.2}), 40, 1e-5);
    EXPECT_NEAR(light_on_plane(road, grid, lamp, LampKind::Cone, {2 / 1.2, 1 / 1.2}),
                40 * std::pow(5 / std::sqrt(29.0), 3), 1e-5);
    EXPECT_EQ(light_on_plane({{0, -1, 0}, 1.0, 0}, grid, lamp, LampKind::Cone, {0, 1 / 1.2}), 0) << "from behind";
}

}  // namespace
}  // namespace vesper::reference::blocks_reference_test
