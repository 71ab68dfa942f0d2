// The scale of pictures without a unit: closed forms, what does not count, invariance and continuity.
// SPDX-License-Identifier: MIT
#include "analysis/relative_picture.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

std::vector<float> greys(const std::vector<double>& luminances) {
    std::vector<float> rgb;
    for (const double l : luminances) rgb.insert(rgb.end(), 3, float(l));
    return rgb;
}
std::vector<float> uniform(size_t pixels, double luminance) { return greys(std::vector<double>(pixels, luminance)); }
void append(std::vector<float>& rgb, size_t pixels, float r, float g, float b) {
    for (size_t i = 0; i < pixels; ++i) rgb.insert(rgb.end(), {r, g, b});
}
/// 10,000 pixels, logarithms normal about `middle` with a deviation of 0.6 decades.
std::vector<double> street(double middle = -1) {
    std::mt19937 random(7);
    std::normal_distribution<double> log(middle, 0.6);
    std::vector<double> all(10000);
    for (double& l : all) l = std::pow(10, log(random));
    return all;
}
double scale_of(const std::vector<float>& rgb) { return analysis::plausible_scale(analysis::relative_luminance(rgb)); }

// Floats hold seven digits, the scale has six.
constexpr double kDigits = 1e-5;

TEST(RelativePicture, OfOneLuminanceIsAsBrightAsTheBrightestScene) {
    for (const double l : {1e-6, 0.18, 1.0, 4e5}) {
        const analysis::RelativeLuminance found = analysis::relative_luminance(uniform(640, l));
        EXPECT_NEAR(found.log_average / l, 1, kDigits);
        EXPECT_NEAR(found.highlights / l, 1, kDigits);
        EXPECT_EQ(analysis::plausible_luminance(found), 3000);
        EXPECT_NEAR(analysis::plausible_scale(found) * l / 3000, 1, kDigits);
    }
}

TEST(RelativePicture, OfTwoLuminancesFollowsTheRule) {
    // 900 of 1 and 100 of 100: the log average is 10^(0.1 2), a tenth of a thousandth of 1000 pixels is left out.
    std::vector<double> two(1000, 1.0);
    std::fill(two.begin(), two.begin() + 100, 100.0);
    const analysis::RelativeLuminance found = analysis::relative_luminance(greys(two));
    EXPECT_NEAR(found.log_average, std::pow(10, 2 * 99 / 999.0), 1e-5)
        << "of 999 pixels, as the brightest thousandth does not count";
    EXPECT_NEAR(found.highlights, 100, 1e-3);
    EXPECT_NEAR(analysis::plausible_luminance(found), std::pow(10, 3.5 - 0.75 * (2 - 2 * 99 / 999.0)), 1e-3);
    EXPECT_NEAR(analysis::plausible_scale(found), analysis::plausible_luminance(found) / found.log_average,
                kDigits * analysis::plausible_scale(found));
    EXPECT_EQ(analysis::plausible_luminance({1, 1e9}), 0.1) << "no darker than a night";
}

// Half of the brightest hundredth, less the brightest thousandth: 4 of 9 logarithms of 2.
TEST(RelativePicture, HighlightsAreALogAverage) {
    std::vector<double> lamps(1000, 1.0);
    std::fill(lamps.begin(), lamps.begin() + 5, 100.0);
    EXPECT_NEAR(analysis::relative_luminance(greys(lamps)).highlights, std::pow(10, 2 * 4 / 9.0), 1e-4);
}

TEST(RelativePicture, BordersSunsAndDamageDoNotCount) {
    const std::vector<float> rgb = greys(street());
    const double scale = scale_of(rgb);
    std::vector<float> more = rgb;
    append(more, 5000, 0, 0, 0);
    EXPECT_EQ(scale_of(more), scale) << "black borders";
    const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
    append(more, 300, nan, 1, 1), append(more, 300, inf, 1, 1), append(more, 300, -inf, 1, 1),
        append(more, 300, -5, -1, -1);
    EXPECT_EQ(scale_of(more), scale) << "no light";
    // Noise of a lossy border, 1e-9 of the highlights: none of it counts in the log average; it counts for which
    // hundredth is brightest.
    std::vector<float> noisy = rgb;
    append(noisy, 1000, 1e-9f, 1e-9f, 1e-9f);
    EXPECT_NEAR(analysis::relative_luminance(noisy).log_average / analysis::relative_luminance(rgb).log_average, 1,
                2e-3);
    EXPECT_NEAR(scale_of(noisy) / scale, 1, 0.05);
    // A sun of less than a thousandth takes the place of as many highlights that did not count either.
    std::vector<float> sunny = uniform(5000, 0.2);
    const double plain = scale_of(sunny);
    for (size_t i = 0; i < 12; ++i) sunny[i] = 1e9f;
    EXPECT_EQ(scale_of(sunny), plain);
}

TEST(RelativePicture, TakesAnyPicture) {
    EXPECT_EQ(scale_of({}), 1);
    EXPECT_EQ(scale_of(uniform(50, 0)), 1);
    EXPECT_EQ(scale_of(uniform(50, std::nan(""))), 1);
    EXPECT_EQ(scale_of(uniform(50, -3)), 1);
    EXPECT_NEAR(scale_of(uniform(1, 0.5)), 6000, 0.1);
    for (const double extreme : {1e-45, 1e-38, 3.4e38}) {
        const double scale = scale_of(uniform(3, extreme));
        EXPECT_TRUE(scale > 0 && std::isfinite(float(scale))) << extreme;
    }
    const double wide = scale_of(greys({1e-38, 1, 3e38}));
    EXPECT_TRUE(wide > 0 && std::isfinite(float(wide * 3e38)));
}

TEST(RelativePicture, AnyMultipleAndAnyOrderIsTheSamePicture) {
    const std::vector<double> all = street();
    const double scale = scale_of(greys(all));
    std::vector<double> mirrored(all.rbegin(), all.rend());
    EXPECT_NEAR(scale_of(greys(mirrored)) / scale, 1, kDigits);
    for (const double factor : {1e-20, 0.5, 3.7, 179.0, 1e20}) {
        std::vector<double> times = all;
        for (double& l : times) l *= factor;
        EXPECT_NEAR(scale_of(greys(times)) * factor / scale, 1, kDigits) << factor;
    }
}

// Lamps that enter pixel by pixel move the picture by little steps only, however much brighter they are.
TEST(RelativePicture, NothingJumps) {
    std::vector<double> all = street();
    double last = scale_of(greys(all)), most = 0;
    for (size_t i = 0; i < 400; ++i) {
        all[i] = 3e3;
        const double scale = scale_of(greys(all));
        most = std::max(most, std::abs(std::log10(scale / last)));
        last = scale;
    }
    // One of the 90 highlights changes by 4 decades, of which 0.75 count, and one of 10,000 pixels by 5, of which 0.25
    // count.
    EXPECT_LE(most, 0.75 * 4.2 / 90 + 0.25 * 6 / 10000);
    EXPECT_GT(most, 0.01);
    // So does a border that grows out of black.
    std::vector<double> framed = street();
    framed.resize(12000, 0.0);
    last = 0;
    for (double log = -12; log < -5; log += 0.01) {
        std::fill(framed.begin() + 10000, framed.end(), std::pow(10, log));
        const double scale = scale_of(greys(framed));
        if (last > 0) {
            EXPECT_LE(std::abs(std::log10(scale / last)), 0.01) << log;
        }
        last = scale;
    }
}

// What the rule says of scenes people know: the order is that of the hours.
TEST(RelativePicture, HighlightsThatStandOutAreNight) {
    EXPECT_NEAR(analysis::plausible_luminance({1, 10}), 562, 1) << "a street by day";
    EXPECT_NEAR(analysis::plausible_luminance({1, 1e3}), 17.8, 0.1) << "a room with a window";
    EXPECT_NEAR(analysis::plausible_luminance({1, 1e5}), 0.562, 0.001) << "a street with lamps";
}

}  // namespace
}  // namespace vesper::test
