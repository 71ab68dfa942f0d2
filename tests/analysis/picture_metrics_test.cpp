// Plain figures of differences against closed forms and published values. SPDX-License-Identifier: MIT
#include "analysis/picture_metrics.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

// Mantiuk and Azimi 2021: 0 at 0.005 cd/m^2, about 256 at 100 cd/m^2, 595 at 10,000.
TEST(PictureMetrics, Pu21HasItsPublishedEnds) {
    EXPECT_NEAR(analysis::pu21(0.005), 0, 1e-6);
    EXPECT_NEAR(analysis::pu21(100), 256.38, 0.01);
    EXPECT_NEAR(analysis::pu21(1), 36.544, 0.001);
    EXPECT_NEAR(analysis::pu21(10000), 595.39, 0.01);
    EXPECT_EQ(analysis::pu21(0), analysis::pu21(0.005));
    EXPECT_EQ(analysis::pu21(1e9), analysis::pu21(1e4));
}

TEST(PictureMetrics, RootMeanSquareIsOfLogarithms) {
    const std::vector<float> a{1, 10, 100, std::nanf("")}, b{10, 10, 100, 3};
    EXPECT_NEAR(analysis::log_rmse(a, b), std::sqrt(1.0 / 3), 1e-12);
    EXPECT_NEAR(analysis::log_rmse(std::vector<float>{0}, std::vector<float>{1}), 4, 1e-12) << "of 1e-4 cd/m^2";
}

TEST(PictureMetrics, PeakSignalToNoiseIsInDecibels) {
    const std::vector<float> a(100, 1.0f), b(100, 100.0f);
    EXPECT_NEAR(analysis::pu21_psnr(a, b), 20 * std::log10(256 / (analysis::pu21(100) - analysis::pu21(1))), 1e-9);
    EXPECT_TRUE(std::isinf(analysis::pu21_psnr(a, a)));
}

// Of uniform pictures only the term of means is left.
TEST(PictureMetrics, SimilarityIsThatOfWang) {
    const uint32_t width = 13, height = 17;
    const std::vector<float> a(width * height, 1.0f), b(width * height, 100.0f);
    const double p = analysis::pu21(1), q = analysis::pu21(100), c1 = 2.56 * 2.56;
    EXPECT_NEAR(analysis::pu21_ssim(a, b, width, height).value(), (2 * p * q + c1) / (p * p + q * q + c1), 1e-9);
    EXPECT_NEAR(analysis::pu21_ssim(a, a, width, height).value(), 1, 1e-12);
    EXPECT_FALSE(analysis::pu21_ssim(a, a, 10, 17 * 13 / 10).has_value()) << "no window fits";
    // A pixel in the middle of a window of 11: its weight w, known moments.
    std::vector<float> dot(121, 1.0f);
    dot[60] = 100;
    double row = 0;
    for (int i = -5; i <= 5; ++i) row += std::exp(-i * i / 4.5);
    const double w = 1 / (row * row), d = q - p, mean = p + w * d, variance = w * d * d * (1 - w), c2 = 7.68 * 7.68;
    EXPECT_NEAR(analysis::pu21_ssim(std::vector<float>(121, 1.0f), dot, 11, 11).value(),
                (2 * p * mean + c1) * c2 / ((p * p + mean * mean + c1) * (variance + c2)), 1e-9);
}

}  // namespace
}  // namespace vesper::test
