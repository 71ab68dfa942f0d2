// Adrian's visibility of targets against computed values of the published equations. SPDX-License-Identifier: MIT
#include "vision/visibility.h"

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

using vision::target_threshold;

// tone-mapping.md, section 8: k = 2.6, 10 arc minutes, 0.2 s, 23 years. Six digits.
TEST(Visibility, ThresholdsAreThoseOfTheTable) {
    const double table[][2]{{0.1, 0.0244061}, {0.5, 0.0542973}, {1, 0.0807713},
                            {2, 0.126164},    {10, 0.405455},   {100, 2.87188}};
    for (const auto& [background, threshold] : table)
        EXPECT_NEAR(target_threshold(background) / threshold, 1, 1e-5) << background;
    EXPECT_NEAR(target_threshold(1, {.seconds = 2}) / 0.0497786, 1, 1e-5);
    EXPECT_NEAR(target_threshold(1, {.darker = true}) / 0.0476494, 1, 1e-5);
    EXPECT_NEAR(target_threshold(1, {.size = 30}) / 0.0296644, 1, 1e-5);
    EXPECT_NEAR(target_threshold(1, {.age = 60}) / 0.143194, 1, 1e-5);
}

TEST(Visibility, LevelIsDifferenceOverThreshold) {
    EXPECT_NEAR(vision::visibility_level(1 + 3 * 0.0807713, 1), 3, 1e-4);
    EXPECT_NEAR(vision::visibility_level(1 - 2 * 0.0476494, 1), -2, 1e-4) << "darker";
    EXPECT_EQ(vision::visibility_level(1, 1), 0);
}

// The three pieces over background luminance meet within 2 %, and older eyes see less.
TEST(Visibility, GoesOnAcrossThePieces) {
    for (double edge : {0.6, 0.00418})
        EXPECT_NEAR(target_threshold(edge * 1.0001) / target_threshold(edge * 0.9999), 1, 0.02) << edge;
    EXPECT_GT(target_threshold(1, {.age = 70}), target_threshold(1, {.age = 63}));
}

}  // namespace
}  // namespace vesper::test
