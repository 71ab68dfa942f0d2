// Loss of acuity in double. SPDX-License-Identifier: MIT
#include "passes/acuity_reference.h"

#include <gtest/gtest.h>

namespace vesper::reference::acuity_reference_test {
namespace {

TEST(AcuityReference, EvenFieldsStayAndLuminanceIsBlurredToGrey) {
    std::vector<dvec3> image(64 * 64, dvec3(0.001, 0.002, 0.004));
    auto levels = pyramid(std::span<const dvec3>(image), 64u, 64u);
    const dvec3 same = seen(image[0], 20, 30, levels, 5, 32);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(same[c], image[0][c], 1e-12);
    image[30 * 64 + 20] = dvec3(0.1, 0, 0);
    levels = pyramid(std::span<const dvec3>(image), 64u, 64u);
    const dvec3 spot = seen(image[30 * 64 + 20], 20, 30, levels, 5, 32), beside = seen(image[0], 21, 31, levels, 5, 32);
    EXPECT_EQ(spot.y, 0) << "dimmed in its colour";
    EXPECT_LT(luminance(spot), 0.212639 * 0.02);
    EXPECT_NEAR(beside.y - beside.x, 0.001, 1e-12) << "lit by grey";
    EXPECT_GT(luminance(beside), luminance(image[0]));
}

TEST(AcuityReference, LevelsAreLinearBetweenTheMiddlesOfTexels) {
    PyramidLevel level{2, 1, {dvec4(1, 4, 0, 0), dvec4(3, 4, 0, 0)}};
    EXPECT_EQ(luminance_at(level, 1, 0, 0), 1);
    EXPECT_EQ(luminance_at(level, 1, 1, 0), 1.5);
    EXPECT_EQ(luminance_at(level, 1, 2, 0), 2.5);
    EXPECT_EQ(luminance_at(level, 1, 3, 1), 3);
}

}  // namespace
}  // namespace vesper::reference::acuity_reference_test
