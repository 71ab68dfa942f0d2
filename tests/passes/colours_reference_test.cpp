// The reference of mean colours, by hand. SPDX-License-Identifier: MIT
#include "passes/colours_reference.h"

#include <gtest/gtest.h>

namespace vesper::reference::colours_reference_test {
namespace {

TEST(ColoursReference, MeansAreOfTheFinitePixelsOfATile) {
    std::vector<dvec3> scene(33, dvec3(1, 2, 3));
    scene[0] = {3, 6, 9};
    scene[1].y = std::numeric_limits<double>::quiet_NaN();
    scene[32] = {7, 8, 9};
    const PyramidLevel tiles = colour_tiles(std::span<const dvec3>(scene), 33, 1);
    ASSERT_EQ(tiles.width, 2u);
    ASSERT_EQ(tiles.height, 1u);
    const double mean = (30 + 3) / 31.0;  // 30 pixels of 1, one of 3, one left out
    EXPECT_NEAR(glm::length(tiles.at(0, 0) - dvec4(mean, 2 * mean, 3 * mean, 31)), 0, 1e-12);
    EXPECT_EQ(tiles.at(1, 0), dvec4(7, 8, 9, 1));
}

TEST(ColoursReference, ATileWithoutFinitePixelsIsBlack) {
    const std::vector<dvec3> scene(4, dvec3(std::numeric_limits<double>::infinity()));
    EXPECT_EQ(colour_tiles(std::span<const dvec3>(scene), 2, 2).at(0, 0), dvec4(0));
}

}  // namespace
}  // namespace vesper::reference::colours_reference_test
