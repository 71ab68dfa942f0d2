// The reference of projections, by hand. SPDX-License-Identifier: MIT
#include "passes/projection_reference.h"

#include <gtest/gtest.h>

namespace vesper::reference::projection_reference_test {
namespace {

// Light that is linear over the picture is so between its pixels, and stays the same beyond the middles of the last.
TEST(ProjectionReference, LinearLightStaysLinear) {
    std::vector<dvec3> light;
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 9; ++x) light.emplace_back(0.1 * (x + 0.5), 0.2 * (y + 0.5), 0.5);
    const std::span<const dvec3> picture(light);
    for (const float x : {0.0f, 0.5f, 2.25f, 8.5f, 11.0f})
        for (const float y : {-3.0f, 1.0f, 3.75f, 5.0f}) {
            const dvec3 got = projected_light(picture, 9, 5, {{x, y}, 0.25f});
            EXPECT_NEAR(got.x, 0.025 * std::clamp(double(x), 0.5, 8.5), 1e-15);
            EXPECT_NEAR(got.y, 0.05 * std::clamp(double(y), 0.5, 4.5), 1e-15);
            EXPECT_NEAR(got.z, 0.125, 1e-15);
        }
}

TEST(ProjectionReference, CodesAreOfTheLightAndNothingIsDarkest) {
    const std::vector<dvec3> light{{1, 0.5, 0}};
    const vision::Display display{.gamma = 2};
    const dvec3 half = projected(std::span<const dvec3>(light), 1, 1, {{0.5f, 0.5f}, 0.25f}, display);
    EXPECT_NEAR(half.x, 127.5, 1e-12);  // a quarter of the light is half the signal of gamma 2
    EXPECT_NEAR(half.y, 255 * std::sqrt(0.125), 1e-12);
    EXPECT_EQ(half.z, 0);
    EXPECT_EQ(projected(std::span<const dvec3>(light), 1, 1, {{0.5f, 0.5f}, -1}, display), dvec3(0));
    EXPECT_EQ(projected(std::span<const dvec3>(light), 1, 1, {{0.5f, 0.5f}, 0}, display), dvec3(0));
}

}  // namespace
}  // namespace vesper::reference::projection_reference_test
