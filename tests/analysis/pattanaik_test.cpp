// The adaptation model of Pattanaik et al. 2000 against computed values of its equations. SPDX-License-Identifier: MIT
#include "analysis/pattanaik.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

// tone-mapping.md, section 4: half saturation of cones and rods. Six digits.
TEST(Pattanaik, HalfSaturationsAreThoseOfTheTable) {
    const double table[][3]{{1e-3, 13.0936, 0.0312609}, {0.01, 13.7690, 0.213156}, {0.1, 18.2352, 1.45230},
                            {1, 75.3453, 9.89445},      {10, 350.759, 67.4101},    {25, 646.106, 144.658},
                            {100, 1628.08, 459.260},    {1e3, 7556.90, 3128.90},   {1e4, 35076, 21317}};
    for (const auto& [adaptation, cones, rods] : table) {
        EXPECT_NEAR(analysis::pattanaik::cone_sigma(adaptation) / cones, 1, 2e-5) << adaptation;
        EXPECT_NEAR(analysis::pattanaik::rod_sigma(adaptation) / rods, 1, 3e-5) << adaptation;
    }
}

// dB/dt = (1 - B) / tau - B G / (tau half), in very small steps.
TEST(Pattanaik, TimeIsIntegratedExactly) {
    analysis::pattanaik::State small = analysis::pattanaik::adapted(2000, 2000);
    const analysis::pattanaik::State once = analysis::pattanaik::after(small, 0.5, 0.25, 3);
    double b = small.cone_pigment, r = small.rod_pigment;
    for (int i = 0; i < 30000; ++i) {
        small = analysis::pattanaik::after(small, 0.5, 0.25, 1e-4);
        b += 1e-4 * ((1 - b) / 110 - b * 0.5 / 2.2e8), r += 1e-4 * ((1 - r) / 400 - r * 0.25 / 16);
    }
    EXPECT_NEAR(small.cones, once.cones, 1e-9);
    EXPECT_NEAR(small.rod_pigment, once.rod_pigment, 1e-9);
    EXPECT_NEAR(once.cone_pigment, b, 1e-6);
    EXPECT_NEAR(once.rod_pigment, r, 1e-6);
    EXPECT_NEAR(analysis::pattanaik::after(once, 7, 7, 1e5).rod_pigment, 0.04 / 7.04, 1e-9);
    EXPECT_NEAR(analysis::pattanaik::after(once, 7, 7, 0).cones, once.cones, 1e-12);
}

// The observer of the display sees what it shows: adapted to 25 cd/m^2 without rods the picture is the scene over 125
// cd/m^2.
TEST(Pattanaik, TheDisplaysObserverSeesTheSceneAsItIs) {
    analysis::pattanaik::State state = analysis::pattanaik::adapted(25, 25);
    state.rod_pigment = 0, state.cone_pigment = 1;
    const analysis::pattanaik::Appearance appearance(state);
    for (double luminance : {4.0, 25.0, 100.0, 120.0})
        EXPECT_NEAR(appearance(luminance, luminance).luminance, luminance / 125, 1e-9) << luminance;
    EXPECT_EQ(appearance(10, 10).cone_share, 1);
    // S_d = 0.138311 (computed there): n x / (1 + x)^2 / S_d is largest, n / 4 / S_d, at L = sigma.
    EXPECT_NEAR(appearance(646.106, 1).colour_exponent, 0.73 / 4 / 0.138311, 1e-4);
}

// What is brighter for rods is shown brighter and greyer, in dim light and not by day.
TEST(Pattanaik, RodsSeeScotopicLuminance) {
    const analysis::pattanaik::Appearance night(analysis::pattanaik::adapted(0.01, 0.02)),
        day(analysis::pattanaik::adapted(1000, 2000));
    EXPECT_GT(night(0.01, 0.04).luminance, 1.3 * night(0.01, 0.01).luminance);
    EXPECT_LT(night(0.01, 0.04).cone_share, night(0.01, 0.01).cone_share);
    EXPECT_NEAR(day(1000, 4000).luminance / day(1000, 1000).luminance, 1, 1e-3);
    EXPECT_NEAR(night.cones(0.01) / (night.cones(0.01) + night.rods(0.04)), night(0.01, 0.04).cone_share, 1e-12);
}

TEST(Pattanaik, IsMonotoneAndGoesGreyInTheDark) {
    for (double adaptation : {0.01, 1.0, 100.0, 1e4}) {
        const analysis::pattanaik::Appearance appearance(analysis::pattanaik::adapted(adaptation, 2.5 * adaptation));
        double before = -1;
        for (double l = -4; l < 7; l += 0.1) {
            const double shown = appearance(std::pow(10, l), 2.5 * std::pow(10, l)).luminance;
            EXPECT_GE(shown, before);
            before = shown;
        }
    }
    EXPECT_LT(analysis::pattanaik::Appearance(analysis::pattanaik::adapted(0.01, 0.01))(0.01, 0.01).cone_share, 0.1);
    EXPECT_GT(analysis::pattanaik::Appearance(analysis::pattanaik::adapted(1000, 1000))(1000, 1000).cone_share, 0.95);
}

}  // namespace
}  // namespace vesper::test
