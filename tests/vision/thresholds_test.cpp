// Threshold curves, pupils and acuity against tabulated values. SPDX-License-Identifier: MIT
#include "vision/thresholds.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

// Six digits are tabulated.
constexpr double kTableDigits = 5e-6;

// tone-mapping.md, 1.1: log10 L, cones, rods, both.
TEST(Thresholds, OfConesRodsAndBothAreThoseOfTheTable) {
    const double table[][4]{{-4, 0.190546, 0.00138038, 0.00138},    {-3, 0.190546, 0.00184003, 0.00184003},
                            {-2, 0.193277, 0.00547234, 0.00547234}, {-1, 0.231643, 0.0402717, 0.0402717},
                            {-0.5, 0.285768, 0.127350, 0.127350},   {0, 0.391302, 0.402717, 0.391302},
                            {1, 1.07190, 4.02717, 1.07190},         {1.5, 2.21169, 12.7350, 2.21169},
                            {2, 5.55904, 40.2717, 5.55904},         {3, 55.5904, 402.717, 55.5904},
                            {4, 555.904, 4027.17, 555.904}};
    for (const auto& [l, cones, rods, both] : table) {
        const double luminance = std::pow(10, l);
        EXPECT_NEAR(vision::cone_threshold(luminance) / cones, 1, kTableDigits) << l;
        EXPECT_NEAR(vision::rod_threshold(luminance) / rods, 1, kTableDigits) << l;
        EXPECT_NEAR(vision::human_threshold(luminance) / both, 1, kTableDigits) << l;
    }
}

// The steps of the published branches: 0.003 and 0.012 log units; none at the continuous break points.
TEST(Thresholds, BranchesMeetWhereTheyShould) {
    const auto step = [](double (*threshold)(double, vision::ThresholdBreaks), double l,
                         vision::ThresholdBreaks breaks) {
        return std::log10(threshold(std::pow(10, l + 1e-9), breaks) / threshold(std::pow(10, l - 1e-9), breaks));
    };
    const auto published = vision::ThresholdBreaks::published(), continuous = vision::ThresholdBreaks::continuous();
    EXPECT_NEAR(step(vision::cone_threshold, 1.9, published), -0.003, 5e-4);
    EXPECT_NEAR(std::abs(step(vision::rod_threshold, -1.44, published)), 0.012, 5e-4);
    EXPECT_NEAR(step(vision::cone_threshold, continuous.cones, continuous), 0, 1e-5);
    EXPECT_NEAR(step(vision::rod_threshold, continuous.rods, continuous), 0, 5e-4) << "almost touch";
    for (double l = -6; l < 6; l += 0.01) {
        EXPECT_GE(vision::human_threshold(std::pow(10, l + 0.01), continuous),
                  vision::human_threshold(std::pow(10, l), continuous) * (1 - 1e-9))
            << l;
        EXPECT_LT(std::abs(step(vision::human_threshold, l, continuous)), 5e-4) << l;
    }
}

TEST(Thresholds, AreFiniteFarOutside) {
    for (double luminance : {1e-30, 1e30})
        for (auto breaks : {vision::ThresholdBreaks::published(), vision::ThresholdBreaks::continuous()})
            for (double t : {vision::cone_threshold(luminance, breaks), vision::rod_threshold(luminance, breaks),
                             vision::human_threshold(luminance, breaks)}) {
                EXPECT_TRUE(std::isfinite(t));
                EXPECT_GT(t, 0);
            }
}

// tone-mapping.md, 2.4: diameter and trolands after Moon and Spencer.
TEST(Thresholds, PupilsOfMoonAndSpencer) {
    const double table[][3]{{-4, 7.665, 0.00461}, {-2, 6.892, 0.3731}, {-1, 6.040, 2.865}, {0, 4.900, 18.86},
                            {1, 3.760, 111.1},    {1.5, 3.289, 268.6}, {2, 2.908, 664.1},  {3, 2.399, 4520},
                            {4, 2.135, 35800},    {5, 2.008, 316650}};
    for (const auto& [l, diameter, td] : table) {
        EXPECT_NEAR(vision::pupil_moon_spencer(std::pow(10, l)), diameter, 6e-4) << l;
        EXPECT_NEAR(vision::trolands(std::pow(10, l)) / td, 1, 1.5e-3) << l;  // three digits in places
    }
    EXPECT_NEAR(vision::trolands(5296) / std::pow(10, 4.3), 1, 1e-3) << "half bleach";
}

// Limits of the published formula, and that age and one eye go the right way.
TEST(Thresholds, PupilsOfWatsonAndYellott) {
    EXPECT_NEAR(vision::pupil_watson_yellott(1e-12, 1), 7.75, 1e-4);
    EXPECT_NEAR(vision::pupil_watson_yellott(846, 1), 7.75 - 5.75 / 3, 1e-12);
    EXPECT_NEAR(vision::pupil_watson_yellott(8460, 1, 28.58, false), 7.75 - 5.75 / 3, 1e-12);
    EXPECT_LT(vision::pupil_watson_yellott(1, 100, 70), vision::pupil_watson_yellott(1, 100, 25));
}

// tone-mapping.md, section 3.
TEST(Thresholds, AcuityFallsInTheDark) {
    const double table[][2]{{1e-3, 3.01}, {0.01, 5.31}, {0.1, 11.75}, {1, 31.5}, {10, 43.9}, {100, 47.5}};
    for (const auto& [luminance, cycles] : table) EXPECT_NEAR(vision::acuity(luminance) / cycles, 1, 2e-3) << luminance;
}

TEST(Thresholds, OlderEyesNeedMore) {
    EXPECT_EQ(vision::age_factor(18), 1);
    EXPECT_EQ(vision::age_factor(23), 1);
    EXPECT_NEAR(vision::age_factor(60), 41.0 * 41 / 2160 + 0.99, 1e-12);
    EXPECT_NEAR(vision::age_factor(70), 13.4 * 13.4 / 116.3 + 1.43, 1e-12);
    EXPECT_EQ(vision::age_factor(90), vision::age_factor(75)) << "no data";
}

// By hand from the formula: light of equal energy, incandescent light (A), daylight (D65). Measured spectra
// have 2.26, 1.41, 2.47.
TEST(Thresholds, ScotopicLuminanceOfAColour) {
    EXPECT_NEAR(vision::scotopic_luminance(1, 1, 1), 2.31, 1e-12);
    EXPECT_NEAR(vision::scotopic_luminance(2 * 1.0985, 2, 2 * 0.3558), 2 * 1.29156, 1e-4);
    EXPECT_NEAR(vision::scotopic_luminance(0.950456, 1, 1.089058), 2.57328, 1e-5);
    EXPECT_EQ(vision::scotopic_luminance(0.73, 0.1, 0), 0) << "deep red";
    EXPECT_EQ(vision::scotopic_luminance(0, 0, 0), 0);
}

}  // namespace
}  // namespace vesper::test
