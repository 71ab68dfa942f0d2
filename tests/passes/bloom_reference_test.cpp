// The display-image glare: a normalised Gaussian, and how near the small separable one comes.
// SPDX-License-Identifier: MIT
#include "passes/bloom_reference.h"

#include <numeric>

#include <gtest/gtest.h>

namespace vesper::reference::bloom_reference_test {
namespace {

LightImage black(uint32_t width, uint32_t height) {
    return {width, height, std::vector<dvec3>(size_t(width) * height, dvec3(0))};
}

double total(const LightImage& image) {
    double sum = 0;
    for (dvec3 p : image.pixels) sum += p.y;
    return sum;
}

TEST(BloomReference, GaussianSumsToOneAndIsCutAtThreeSigma) {
    for (double sigma : {0.05, 0.4, 1.0, 2.3, 9.0}) {
        const auto w = gaussian(sigma);
        EXPECT_EQ(w.size(), size_t(std::ceil(3 * sigma)) + 1);
        EXPECT_NEAR(2 * std::accumulate(w.begin(), w.end(), 0.0) - w[0], 1, 1e-14);
    }
    const auto w = gaussian(2);
    EXPECT_NEAR(w[2] / w[0], std::exp(-0.5), 1e-14);
    EXPECT_NEAR(w[4] / w[0], std::exp(-2.0), 1e-14);
    EXPECT_EQ(gaussian(0), std::vector<double>{1});
}

TEST(BloomReference, OnlyWhatReachesTheThresholdGlares) {
    EXPECT_EQ(glaring(dvec3(0.89), 0.9), dvec3(0));
    EXPECT_EQ(glaring(dvec3(0.9 + 1e-12), 0.9), dvec3(0.9 + 1e-12));
    EXPECT_EQ(glaring({1, 0, 0}, 0.9), dvec3(1, 0, 0)) << "a red lamp as bright as the display can show it";
    EXPECT_EQ(glaring({0.8, 0.89, 0.3}, 0.9), dvec3(0));
}

TEST(BloomReference, BlocksAreMeansOfThePixelsThatExist) {
    LightImage shown = black(6, 5);
    shown.at(0, 0) = shown.at(5, 4) = dvec3(1);
    shown.at(1, 1) = dvec3(0.5);
    const LightImage small = bright(shown, 0.9);
    EXPECT_EQ(small.width, 2u);
    EXPECT_EQ(small.height, 2u);
    EXPECT_EQ(small.at(0, 0), dvec3(1.0 / 16));
    EXPECT_EQ(small.at(1, 1), dvec3(1.0 / 2)) << "two pixels wide, one high";
}

TEST(BloomReference, LightIsSpreadNotMade) {
    LightImage shown = black(160, 120);
    for (uint32_t i = 70; i < 83; ++i) shown.at(i, 61) = dvec3(1);
    const LightImage small = bloom(shown, 0.9, 2.5);
    EXPECT_NEAR(total(small) * 16, 13, 1e-9);
    EXPECT_NEAR(total(direct_glare(shown, 0.9, 10)), 13, 1e-9);
}

TEST(BloomReference, WhatLeavesTheImageIsLost) {
    LightImage shown = black(64, 64);
    shown.at(0, 30) = dvec3(1);
    EXPECT_LT(total(bloom(shown, 0.9, 3)) * 16, 0.62);
    EXPECT_GT(total(bloom(shown, 0.9, 3)) * 16, 0.5);
}

TEST(BloomReference, BlurringTwiceIsBlurringWider) {
    LightImage shown = black(81, 81);
    shown.at(40, 40) = dvec3(1);
    const auto w3 = gaussian(3), w4 = gaussian(4), w5 = gaussian(5);
    const auto twice = blur(blur(shown, w3, true), w4, true), once = blur(shown, w5, true);
    for (uint32_t x = 0; x < 81; ++x)  // variances add; the cut at 3 sigma costs 0.3 % of the light
        EXPECT_NEAR(twice.at(x, 40).y, once.at(x, 40).y, 0.02 * once.at(40, 40).y);
}

TEST(BloomReference, DirectGlareOfAPointIsTheGaussian) {
    LightImage shown = black(61, 61);
    shown.at(30, 30) = dvec3(1);
    const LightImage glare = direct_glare(shown, 0.9, 5);
    const double peak = 1 / (2 * 3.14159265358979 * 25);
    EXPECT_NEAR(glare.at(30, 30).x, peak, 5e-4 * peak);
    EXPECT_NEAR(glare.at(35, 30).x / glare.at(30, 30).x, std::exp(-0.5), 1e-12);
    EXPECT_NEAR(glare.at(33, 34).x, glare.at(35, 30).x, 1e-15) << "round";
}

/// Largest difference between the definition and the pass's way, relative to the largest glare.
double approximation_error(const LightImage& shown, double sigma) {
    const LightImage exact = direct_glare(shown, 0.9, sigma), small = bloom(shown, 0.9, sigma / kGlareBlock);
    double worst = 0, most = 0;
    for (uint32_t y = 0; y < shown.height; ++y)
        for (uint32_t x = 0; x < shown.width; ++x) {
            const dvec3 up = bilinear(std::span<const dvec3>(small.pixels), small.width, small.height,
                                      (dvec2(x, y) + 0.5) / 4.0 - 0.5);
            worst = std::max(worst, std::abs(up.y - exact.at(x, y).y)), most = std::max(most, exact.at(x, y).y);
        }
    return worst / most;
}

// What the quarter resolution costs: block and bilinear filter widen the Gaussian by about (16 + 2 * 16) / 12 px^2 of
// variance, 4 / sigma^2 of the peak. The street's own view has sigma = 8.6 px or more.
TEST(BloomReference, TheSmallGlareIsNearTheDefinition) {
    LightImage shown = black(96, 80);
    for (uint32_t y = 30; y < 36; ++y)
        for (uint32_t x = 41; x < 48; ++x) shown.at(x, y) = dvec3(1, 0.95, 0.9);
    EXPECT_LT(approximation_error(shown, 6), 0.11);
    EXPECT_LT(approximation_error(shown, 9), 0.06);
    EXPECT_LT(approximation_error(shown, 12), 0.04);
}

TEST(BloomReference, SigmaIsGivenAsAnAngle) { EXPECT_DOUBLE_EQ(small_sigma(0.35, 0.035), 2.5); }

}  // namespace
}  // namespace vesper::reference::bloom_reference_test
