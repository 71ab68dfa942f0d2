// The adapting eye against the worked tables of its specification. SPDX-License-Identifier: MIT
#include "vision/eye.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

const vision::ReceptorModel kCones(vision::ReceptorKind::Cones, vision::Receptors::cones());
const vision::ReceptorModel kRods(vision::ReceptorKind::Rods, vision::Receptors::rods());

// tone-mapping.md, 2.4.
TEST(Eye, AdaptedConesHaveTheTabulatedState) {
    EXPECT_NEAR(kCones.response_step(), 0.0123534, 5e-8);
    EXPECT_NEAR(kCones.dark_sigma(), 15.4245, 6e-5);
    // log10 L, sigma, pigment
    const double table[][3]{{-4, 15.4244, 1},      {-2, 15.6256, 1},      {-1, 18.5507, 0.99986},
                            {0, 29.6418, 0.99906}, {1, 65.2368, 0.99447}, {1.5, 106.390, 0.98671},
                            {2, 200, 0.96779},     {3, 2000, 0.81530},    {4, 20000, 0.35788},
                            {5, 200000, 0.05928}};
    for (const auto& [l, sigma, pigment] : table) {
        const double luminance = std::pow(10, l);
        EXPECT_NEAR(kCones.adapted_sigma(luminance) / sigma, 1, 5e-6) << l;
        EXPECT_NEAR(kCones.adapted_pigment(luminance), pigment, 2e-5) << l;  // written as 1 at 1e-2
        EXPECT_NEAR(kCones.sigma(kCones.adapted(luminance)) / sigma, 1, 5e-6) << "through the state, " << l;
    }
}

TEST(Eye, AdaptedRodsHaveTheTabulatedState) {
    EXPECT_NEAR(kRods.response_step(), 0.0894927, 5e-8);
    EXPECT_NEAR(kRods.dark_sigma(), 0.0154246, 5e-8);
    const double table[][2]{{1e-4, 0.0152239}, {1e-3, 0.0185067}, {1e-2, 0.0385548}, {0.1, 0.2}, {1, 2}};
    for (const auto& [luminance, sigma] : table)
        EXPECT_NEAR(kRods.adapted_sigma(luminance) / sigma, 1, 5e-6) << luminance;
}

// The reason for the closed form: whatever the parameters, the adapted eye has the published thresholds.
TEST(Eye, AdaptedThresholdsArePublished) {
    for (double c : {1.5, 2.0, 8.0})
        for (double factor : {1.0, 3.0}) {
            vision::Receptors r = vision::Receptors::cones();
            r.semi_saturation = c, r.threshold_factor = factor;
            const vision::ReceptorModel model(vision::ReceptorKind::Cones, r);
            double before = 0;
            for (double l = -4; l < 6; l += 0.05) {
                const double luminance = std::pow(10, l), sigma = model.adapted_sigma(luminance);
                EXPECT_NEAR(model.threshold(luminance, sigma) /
                                (factor * vision::cone_threshold(luminance, vision::ThresholdBreaks::continuous())),
                            1, 1e-9);
                EXPECT_GE(sigma, luminance * (1 - 1e-12));
                EXPECT_GE(sigma, before * 0.999) << "monotone, but for a dip of 2e-4 near 3e-3 cd/m^2";
                before = sigma;
            }
        }
}

// tone-mapping.md, 2.5: contrast thresholds at L (columns) of an eye adapted to A (rows).
TEST(Eye, MalAdaptedThresholdsAreThoseOfTheTable) {
    const double luminances[]{0.01, 0.1, 1, 10, 100, 1e3, 1e4, 1e5};
    const struct {
        double adapted, contrast[8];
    } table[]{{0.1, {22.94, 2.316, 0.2545, 0.05428, 0.09359, 0.6909, 6.684, 66.62}},
              {1, {36.64, 3.687, 0.3913, 0.06549, 0.07004, 0.4418, 4.192, 41.70}},
              {10, {80.61, 8.084, 0.8308, 0.1072, 0.05170, 0.2149, 1.918, 18.96}},
              {100, {247.1, 24.73, 2.495, 0.2724, 0.05559, 0.08894, 0.6426, 6.201}},
              {1000, {2471, 247.1, 24.73, 2.495, 0.2724, 0.05559, 0.08894, 0.6426}},
              {5000, {1.235e4, 1235, 123.6, 12.38, 1.260, 0.1495, 0.04941, 0.1495}}};
    for (const auto& [adapted, row] : table)
        for (int i = 0; i < 8; ++i)
            EXPECT_NEAR(kCones.threshold(luminances[i], kCones.adapted_sigma(adapted)) / luminances[i] / row[i], 1,
                        4e-4)  // four digits
                << adapted << " sees " << luminances[i];
}

// tone-mapping.md, 2.5: what is exact against what is linear, at the adapted state, and where nothing can be seen.
TEST(Eye, IncrementsAndDecrements) {
    for (double luminance : {1.0, 10.0, 100.0, 1e4}) {
        const double sigma = kCones.adapted_sigma(luminance), linear = kCones.threshold(luminance, sigma);
        const double up = *kCones.increment(luminance, sigma) / linear - 1,
                     down = *kCones.decrement(luminance, sigma) / linear - 1;
        EXPECT_GT(up, 0.0125);
        EXPECT_LT(up, 0.0195);
        EXPECT_LT(down, -0.0125);
        EXPECT_GT(down, -0.0185);
    }
    EXPECT_FALSE(kCones.decrement(0.1, kCones.adapted_sigma(0.1))) << "R0 <= Delta R: deep in the dark";
    EXPECT_FALSE(kCones.increment(1e5, kCones.adapted_sigma(0.1))) << "saturated";
    EXPECT_TRUE(kCones.increment(0.1, kCones.adapted_sigma(0.1)));
}

// tone-mapping.md, 2.6: 5000 to 50 cd/m^2 at t = 0. One exact step to each time, and steps of 1/600 s, give the same.
TEST(Eye, ATunnelIsEnteredAsTabulated) {
    // s, sigma, T/L at 50, times the adapted threshold, pigment
    const double table[][5]{{0.05, 4204, 1.064, 17.2, 0.5133}, {0.2, 1772, 0.463, 7.49, 0.5139},
                            {1, 1317, 0.351, 5.68, 0.5170},    {5, 737.8, 0.208, 3.37, 0.5325},
                            {10, 459.0, 0.140, 2.26, 0.5512},  {20, 281.1, 0.0964, 1.56, 0.5862},
                            {60, 184.3, 0.0736, 1.19, 0.7000}, {300, 135.9, 0.0628, 1.02, 0.9445}};
    vision::ReceptorState stepped = kCones.adapted(5000);
    const double adapted = kCones.adapted_threshold(50);
    int steps = 0;
    for (const auto& [seconds, sigma, contrast, times, pigment] : table) {
        while (steps < std::lround(seconds * 600)) stepped = kCones.after(stepped, 50, 1.0 / 600), ++steps;
        const vision::ReceptorState once = kCones.after(kCones.adapted(5000), 50, seconds);
        for (const vision::ReceptorState& state : {once, stepped}) {
            EXPECT_NEAR(kCones.sigma(state) / sigma, 1, 1e-3) << seconds;
            EXPECT_NEAR(kCones.threshold(50, kCones.sigma(state)) / 50 / contrast, 1, 4e-3) << seconds;  // three digits
            EXPECT_NEAR(kCones.threshold(50, kCones.sigma(state)) / adapted / times, 1, 4e-3) << seconds;
            EXPECT_NEAR(state.pigment, pigment, 6e-5) << seconds;
        }
        EXPECT_NEAR(kCones.sigma(stepped) / kCones.sigma(once), 1, 1e-9) << "exact for any step";
    }
}

// tone-mapping.md, 2.6: and out of it, 50 to 5000 cd/m^2. Two digits are given.
TEST(Eye, ATunnelIsLeftAsTabulated) {
    const double table[][2]{{0.02, 6.1}, {0.1, 2.7}, {0.5, 1.7}, {2, 1.44}, {10, 0.96}, {60, 0.92}};
    for (const auto& [seconds, times] : table) {
        const vision::ReceptorState state = kCones.after(kCones.adapted(50), 5000, seconds);
        EXPECT_NEAR(kCones.threshold(5000, kCones.sigma(state)) / kCones.adapted_threshold(5000) / times, 1, 0.02)
            << seconds;
    }
}

TEST(Eye, APauseFreezesAndALongTimeAdapts) {
    const vision::ReceptorState state{0.5, 0.3, 0.7};
    const vision::ReceptorState same = kCones.after(state, 100, 0);
    EXPECT_EQ(same.pigment, state.pigment);
    EXPECT_EQ(same.fast, state.fast);
    EXPECT_EQ(same.slow, state.slow);
    EXPECT_NEAR(kCones.sigma(kCones.after(state, 100, 1e5)), kCones.adapted_sigma(100), 1e-9);
}

TEST(Eye, ObserversHaveTheirThresholds) {
    vision::Observer old;
    old.age = 70, old.low_vision = 2;
    const vision::ReceptorModel model(vision::ReceptorKind::Cones, old.observed_cones());
    EXPECT_NEAR(model.adapted_threshold(10) / kCones.adapted_threshold(10), 2 * vision::age_factor(70), 1e-12);
    EXPECT_NEAR(model.adapted_sigma(10), kCones.adapted_sigma(10), 1e-9) << "the response is the same, its step is not";
}

}  // namespace
}  // namespace vesper::test
