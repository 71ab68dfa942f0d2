// Adrian's visibility of targets against computed values of the published equations. SPDX-License-Identifier: MIT
#include "vision/visibility.h"

#include <cmath>

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

TEST(Visibility, WithinBoundsItIsAdriansAndBeyondThemNone) {
    using vision::bounded_visibility_level;
    for (const double size : {2.0, 10.0, 60.0})
        for (const double background : {1e-4, 0.01, 1.0, 1e4})
            for (const double factor : {0.0, 0.5, 1.5})
                EXPECT_DOUBLE_EQ(*bounded_visibility_level(factor * background, background, {.size = size}),
                                 vision::visibility_level(factor * background, background, {.size = size}))
                    << size << " " << background << " " << factor;
    EXPECT_DOUBLE_EQ(*bounded_visibility_level(2, 1, {.size = 500}), vision::visibility_level(2, 1, {.size = 60}));
    EXPECT_FALSE(bounded_visibility_level(2, 0));
    EXPECT_FALSE(bounded_visibility_level(2, 0.9e-4));
    EXPECT_FALSE(bounded_visibility_level(2, 1.1e4));
    EXPECT_FALSE(bounded_visibility_level(2, std::nan("")));
    EXPECT_FALSE(bounded_visibility_level(HUGE_VAL, 1));
    EXPECT_FALSE(bounded_visibility_level(2, 1, {.size = 0}));
}

// The formula for darker targets is fitted to data and may give less than nothing beyond them.
TEST(Visibility, AThresholdIsAbove0OrThereIsNoLevel) {
    for (double size = 0.5; size <= 60; size *= 1.3)
        for (double background = 1e-4; background < 1e4; background *= 1.7) {
            const auto level = vision::bounded_visibility_level(0.9 * background, background, {.size = size});
            EXPECT_TRUE(!level || *level < 0) << size << " " << background;
        }
}

TEST(Visibility, TheDiscOfTheMoonIsHalfADegree) {
    EXPECT_NEAR(vision::disc_minutes(6.42e-5), 31.1, 0.1);  // its mean solid angle, sr
}

}  // namespace
}  // namespace vesper::test
