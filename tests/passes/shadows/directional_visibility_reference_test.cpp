// Shares of directional lamps: closed forms. SPDX-License-Identifier: MIT
#include "passes/shadows/directional_visibility_reference.h"

#include <gtest/gtest.h>

#include "passes/shadows/penumbra_reference.h"

namespace vesper::test::directional_visibility_reference_test {
namespace {

// Light straight along z, and a plate over x < 0 at some height before the ground.
reference::DirectionalLamp past_edge(double height, double radius) {
    reference::DirectionalLamp lamp{
        .levels = {{glm::dmat3(1), glm::dvec3(0), 16, 1024}}, .distances = {{}}, .radius = radius};
    for (int y = 0; y < 1024; ++y)
        for (int x = 0; x < 1024; ++x) lamp.distances[0].push_back(x < 512 ? 10 - height : 10);
    return lamp;
}

TEST(DirectionalVisibilityReference, IsThatOfADiscPastAnEdge) {
    for (const double height : {2.0, 8.0, 50.0}) {
        constexpr double kRadius = 0.02;
        const reference::DirectionalLamp lamp = past_edge(height, kRadius);
        for (double x = -1.5; x < 1.5; x += 0.01) {
            const double share = reference::directional_share(lamp, glm::dvec3(0), {x, 0.3, 10}, {0, 0, -1}).share;
            // 32 points, up to three of them at the same place across an edge, and a texel of 0.03 m.
            const double texel = 0.04 / (height * kRadius);
            EXPECT_LE(share, reference::disc_beyond(-x / (height * kRadius) - texel) + 0.1) << x;
            EXPECT_GE(share, reference::disc_beyond(-x / (height * kRadius) + texel) - 0.1) << x;
        }
    }
}

TEST(DirectionalVisibilityReference, APlaneNeverHidesItself) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.6, -0.3, -0.4));
    reference::DirectionalLamp lamp{
        .levels = {{glm::dmat3(1), glm::dvec3(0), 16, 256}}, .distances = {{}}, .radius = 0.005};
    const auto depth_at = [&](glm::dvec2 p) { return -glm::dot(glm::dvec2(normal), p) / normal.z; };
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x)
            lamp.distances[0].push_back(depth_at(glm::dvec2(reference::on_level(lamp.levels[0], {x + 0.5, y + 0.5}))));
    for (double x = -9; x < 9; x += 0.37)
        for (double y = -9; y < 9; y += 0.41)
            EXPECT_EQ(reference::directional_share(lamp, glm::dvec3(0), {x, y, depth_at({x, y})}, normal).share, 1);
}

TEST(DirectionalVisibilityReference, NothingHidesWhatIsBeyondTheLevels) {
    const reference::DirectionalLamp lamp = past_edge(5, 0.005);
    EXPECT_EQ(reference::directional_share(lamp, glm::dvec3(0), {-5, 0, 10}, {0, 0, -1}).share, 0);
    EXPECT_EQ(reference::directional_share(lamp, glm::dvec3(0), {-17, 0, 10}, {0, 0, -1}).share, 1);
}

}  // namespace
}  // namespace vesper::test::directional_visibility_reference_test
