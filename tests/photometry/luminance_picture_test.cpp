// Pictures of light sources: what they may hold, and means over parts of them. SPDX-License-Identifier: MIT
#include "photometry/luminance_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "io/hdr_image.h"
#include "support/complaints.h"

namespace vesper::test {
namespace {

double photometric(const float* c) { return 0.212639 * c[0] + 0.715169 * c[1] + 0.072192 * c[2]; }

io::HdrImage grey(uint32_t width, uint32_t height, const std::vector<float>& values) {
    io::HdrImage image{.width = width, .height = height};
    for (const float value : values) image.rgb.insert(image.rgb.end(), 3, value);
    return image;
}

TEST(LuminancePicture, KeepsItsNumbers) {
    io::HdrImage image = grey(2, 1, {1e-6f, 1e8f});
    image.rgb[5] = 3;
    const photometry::LuminancePicture made = photometry::make_luminance_picture(image);
    EXPECT_EQ(made.rgb, image.rgb);
    EXPECT_NEAR(photometry::largest_luminance(made), 0.927808e8, 1);
    EXPECT_NEAR(photometry::mean_colour(made).g, 0.5e8, 1);
    EXPECT_NEAR(photometry::mean_colour(made).b, 1.5, 1e-5);
}

TEST(LuminancePicture, RefusesWhatIsNoNumber) {
    const float inf = std::numeric_limits<float>::infinity();
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), inf, -inf, 2e30f}) {
        io::HdrImage image = grey(3, 2, {1, 1, 1, 1, 1, 1});
        image.rgb[3 * 5 + 1] = bad;
        EXPECT_EQ(complaint_of([&] { photometry::make_luminance_picture(image); }),
                  "pixel (2, 1) is not finite, or beyond 1e30")
            << bad;
    }
}

TEST(LuminancePicture, ColoursOutsideTheGamutKeepTheirLuminance) {
    io::HdrImage image = grey(4, 1, {2, -1, 0, 1});
    const float red[] = {5, -0.4f, -0.1f};  // a tail lamp in Rec. 709
    std::copy(red, red + 3, image.rgb.begin());
    image.rgb[9] = -9;  // of negative luminance
    uint64_t changed = 3;
    const photometry::LuminancePicture made = photometry::make_luminance_picture(image, &changed);
    EXPECT_EQ(changed, 6u);
    EXPECT_NEAR(photometric(&made.rgb[0]) / photometric(red), 1, 1e-6);
    EXPECT_NEAR(made.rgb[1], 0, 1e-6);
    EXPECT_GT(made.rgb[0], 3);
    for (size_t i = 3; i < 12; ++i) EXPECT_EQ(made.rgb[i], 0);
    for (const float value : made.rgb) EXPECT_GE(value, 0);
}

TEST(LuminancePicture, MeansOverTriangles) {
    // 4 x 2: left half 1, right half 9, one texel of 100.
    photometry::LuminancePicture p = photometry::make_luminance_picture(grey(4, 2, {1, 1, 9, 9, 1, 100, 9, 9}));
    const photometry::PictureMeans means(p);
    const auto quad = [&](glm::dvec2 low, glm::dvec2 high) {  // two triangles of equal size
        return (means.over({low, {high.x, low.y}, high}) + means.over({low, high, {low.x, high.y}})) / 2;
    };
    EXPECT_NEAR(quad({0.5, 0}, {1, 1}), 9, 1e-12);
    EXPECT_NEAR(quad({0.5, 1}, {1, 0}), 9, 1e-12) << "upside down";
    EXPECT_NEAR(quad({2.5, -3}, {3, -2}), 9, 1e-12) << "it repeats";
    EXPECT_NEAR(quad({0.25, 0.5}, {0.5, 1}), 100, 1e-9);
    EXPECT_NEAR(quad({0, 0}, {1, 1}), (3 * 1 + 4 * 9 + 100) / 8.0, 1e-9);
    EXPECT_NEAR(quad({-1, 2}, {3, 5}), (3 * 1 + 4 * 9 + 100) / 8.0, 1e-9);
    EXPECT_NEAR(quad({0.25, 0}, {0.5, 1}), 50.5, 1e-9);
    EXPECT_NEAR(means.over({glm::dvec2(0.3, 0.6), {0.3, 0.6}, {0.3, 0.6}}), 100, 1e-9) << "no area: one texel";
    for (const double far : {1e5, 1e30, HUGE_VAL})
        EXPECT_NEAR(means.over({glm::dvec2(0, 0), {far, 0}, {0, far}}), 17.375, 1e-9);
    EXPECT_NEAR(means.over({glm::dvec2(1e30, 0), {1e30, 0.5}, {1e30, 1}}), 17.375, 1e-9);
}

TEST(LuminancePicture, MeansAreThoseOfManyPoints) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<float> values(64 * 64);
    for (float& v : values) v = float(unit(random));
    const photometry::LuminancePicture p = photometry::make_luminance_picture(grey(64, 64, values));
    const photometry::PictureMeans means(p);
    for (int k = 0; k < 20; ++k) {
        std::array<glm::dvec2, 3> uv;
        for (glm::dvec2& at : uv) at = {3 * unit(random) - 1, 3 * unit(random) - 1};
        double sum = 0;
        constexpr int kPoints = 200000;
        for (int i = 0; i < kPoints; ++i) {
            double a = unit(random), b = unit(random);
            if (a + b > 1) a = 1 - a, b = 1 - b;
            const glm::dvec2 at = glm::fract(uv[0] + a * (uv[1] - uv[0]) + b * (uv[2] - uv[0])) * 64.0;
            sum += p.rgb[3 * (size_t(at.y) * 64 + size_t(at.x))];
        }
        EXPECT_NEAR(means.over(uv), sum / kPoints, 0.004);
    }
}

}  // namespace
}  // namespace vesper::test
