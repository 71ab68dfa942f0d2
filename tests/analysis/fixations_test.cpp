// Fixations and rank correlation: by hand. SPDX-License-Identifier: MIT
#include "analysis/fixations.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"

namespace vesper::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// 8 x 4 texels of 10 px, the last of a row 5 px wide; 75 degrees wide and less high.
vision::ImageAngles wide() {
    const double x = std::tan(37.5 * kDegree), y = x * 40 / 75;
    return {75, 40, {-x, -y}, {x, y}};
}

TEST(Fixations, AnglesAreThoseOfDirections) {
    const vision::ImageAngles picture = wide();
    EXPECT_NEAR(analysis::angle_between(picture, {0, 20}, {75, 20}), 75 * kDegree, 1e-12);
    EXPECT_NEAR(analysis::angle_between(picture, {37.5, 20}, {75, 20}), 37.5 * kDegree, 1e-12);
    EXPECT_EQ(analysis::angle_between(picture, {3, 4}, {3, 4}), 0);
}

TEST(Fixations, TheGreatestWinsAndItsSurroundIsInhibited) {
    std::vector<float> values(32);
    values[9] = 0.5f, values[10] = 0.9f, values[11] = 0.8f, values[31] = 0.3f, values[0] = 0.3f;
    values[20] = std::numeric_limits<float>::quiet_NaN(), values[21] = -1;
    const analysis::PictureMap map{8, 4, 10, values};
    // (25, 15) px wins; its neighbours are about 11 degrees away.
    const auto found = analysis::fixations(map, wide(), 15 * kDegree, 10);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].pixels, glm::dvec2(25, 15));
    EXPECT_FLOAT_EQ(float(found[0].value), 0.9f);
    EXPECT_EQ(found[1].pixels, glm::dvec2(5, 5)) << "the first of equals";
    EXPECT_EQ(found[2].pixels, glm::dvec2(72.5, 35)) << "in the middle of the part of the texel that the picture has";
    const auto all = analysis::fixations(map, wide(), 0, 10);
    ASSERT_EQ(all.size(), 5u);
    EXPECT_EQ(all[1].pixels, glm::dvec2(35, 15));
    EXPECT_EQ(all[2].pixels, glm::dvec2(15, 15));
    EXPECT_EQ(analysis::fixations(map, wide(), 0, 2).size(), 2u);
    EXPECT_TRUE(analysis::fixations({8, 4, 10, std::vector<float>(32)}, wide(), 1, 9).empty());
    EXPECT_THROW(analysis::fixations({8, 5, 10, values}, wide(), 1, 9), Error);
}

std::optional<double> correlation(const std::vector<float>& a, const std::vector<float>& b) {
    return analysis::rank_correlation(a, b);
}

TEST(RankCorrelation, IsThatOfSpearman) {
    EXPECT_NEAR(*correlation({1, 2, 3, 4, 5}, {10, 20, 300, 4000, 50000}), 1, 1e-15);
    EXPECT_NEAR(*correlation({1, 2, 3, 4, 5}, {5, 4, 3, 2, 1}), -1, 1e-15);
    // Differences of ranks 2, 0, 1, 1, 2 (1 - 6 * 10 / (5 * 24)).
    EXPECT_NEAR(*correlation({1, 2, 3, 4, 5}, {3, 2, 4, 5, 1}), 1 - 6 * (4 + 0 + 1 + 1 + 16) / 120.0, 1e-15);
    // Ranks 1.5, 1.5, 3, 4 and 1, 2.5, 2.5, 4: sums of products 3.75, of squares 4.5 and 4.5.
    EXPECT_NEAR(*correlation({7, 7, 8, 9}, {1, 2, 2, 3}), 3.75 / 4.5, 1e-15);
}

TEST(RankCorrelation, HasNoneWithoutDifferences) {
    EXPECT_FALSE(correlation({1, 1, 1}, {1, 2, 3}));
    EXPECT_FALSE(correlation({1}, {2}));
    EXPECT_FALSE(correlation({}, {}));
    EXPECT_THROW(correlation({1, 2}, {1, 2, 3}), Error);
    EXPECT_THROW(correlation({1, std::numeric_limits<float>::quiet_NaN()}, {1, 2}), Error);
}

}  // namespace
}  // namespace vesper::test
