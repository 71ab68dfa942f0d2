// Scales, colours and statistics of pictures. SPDX-License-Identifier: MIT
#include "plots/false_colour.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "arguments/arguments.h"
#include "statistics.h"

namespace vesper::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

TEST(FalseColour, GetsLighterWithLuminance) {
    double before = -1;
    for (double position = 0; position <= 1; position += 1.0 / 256) {
        const apps::CanvasColour c = apps::map_colour(position);
        const double lightness =
            0.212639 * std::pow(c.r, 2.2) + 0.715169 * std::pow(c.g, 2.2) + 0.072192 * std::pow(c.b, 2.2);
        EXPECT_GT(lightness, before - 1e-4) << position;
        before = lightness;
    }
    EXPECT_EQ(apps::map_colour(-1), apps::map_colour(0));
    EXPECT_EQ(apps::map_colour(7), apps::map_colour(1));
}

TEST(FalseColour, MarksWhatHasNoColour) {
    const apps::ColourScale scale{0.1, 10};
    EXPECT_NEAR(scale.position(1), 0.5, 1e-12);
    EXPECT_EQ(scale.position(1e9), 1);
    const auto rgba = apps::false_colours({5, 1, {kNan, kInfinity, 0, -1, 1}}, scale);
    for (size_t i : {0, 1}) EXPECT_TRUE(rgba[4 * i] == 255 && rgba[4 * i + 1] == 0 && rgba[4 * i + 2] == 255);
    for (size_t i : {2, 3}) EXPECT_TRUE(rgba[4 * i] == 0 && rgba[4 * i + 1] == 0 && rgba[4 * i + 2] == 0);
    EXPECT_EQ(rgba[17], uint8_t(apps::map_colour(0.5).g * 255 + 0.5));
}

TEST(FalseColour, FindsAScale) {
    std::vector<float> values{0, -1, kNan, kInfinity};
    for (int i = 0; i <= 1000; ++i) values.push_back(0.3f * std::pow(10.0f, float(i) / 250));  // 0.3 to 3000
    const apps::ColourScale scale = apps::scale_of(values);
    EXPECT_DOUBLE_EQ(scale.low, 0.2);
    EXPECT_DOUBLE_EQ(scale.high, 5000);
    const apps::ColourScale even = apps::scale_of(std::vector<float>(10, 2.0f));
    EXPECT_GE(even.high / even.low, 10 - 1e-9);
    EXPECT_TRUE(even.low <= 2 && even.high >= 2);
    EXPECT_GT(apps::scale_of({}).high, apps::scale_of({}).low);
}

TEST(FalseColour, ResizesByMeans) {
    const apps::ValuePicture picture{4, 2, {1, 3, 10, 20, 5, 7, 30, 40}};
    EXPECT_EQ(apps::resized(picture, 2, 1).values, (std::vector<float>{4, 25}));
    EXPECT_EQ(apps::resized({2, 1, {1, 2}}, 4, 2).values, (std::vector<float>{1, 1, 2, 2, 1, 1, 2, 2}));
    EXPECT_TRUE(std::isnan(apps::resized({2, 1, {1, kNan}}, 1, 1).values[0]));
}

TEST(FalseColour, Ticks) {
    EXPECT_EQ(apps::linear_ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
    EXPECT_EQ(apps::linear_ticks(-30, 15, 5).size(), 5u);  // every 10: -30 to 10
    EXPECT_TRUE(apps::linear_ticks(1, 1, 5).empty() && apps::linear_ticks(2, 1, 5).empty());
    const std::vector<double> ticks = apps::log_ticks(0.1, 10);
    EXPECT_EQ(ticks.size(), 7u);
    EXPECT_EQ(apps::log_ticks(1e-3, 1e3).size(), 7u);  // powers of ten alone
    EXPECT_TRUE(apps::log_ticks(0, 1).empty());
    EXPECT_EQ(apps::tick_label(20000), "20000");
    EXPECT_EQ(apps::tick_label(0.05), "0.05");
    EXPECT_EQ(apps::tick_label(-1e-15), "0");
}

TEST(FalseColour, CanvasKeepsPixelsAndClips) {
    apps::Canvas canvas(8, 6);
    const std::vector<uint8_t> dot{10, 20, 30, 255};
    canvas.pixels(3, 2, 1, 1, dot);
    canvas.pixels(-1, 0, 1, 1, dot);
    canvas.pixels(8, 5, 1, 1, dot);
    canvas.text({4, 3}, "", 10);
    canvas.text({1000, 3}, "\xff\xfe no UTF-8", 10, apps::Canvas::Align::Right, apps::CanvasColour(1), true);
    const auto rgba = canvas.rgba();
    const size_t at = 4 * (2 * 8 + 3);
    ASSERT_EQ(rgba.size(), 8u * 6 * 4);
    EXPECT_EQ(rgba[0], 255);
    EXPECT_TRUE(rgba[at] == 10 && rgba[at + 1] == 20 && rgba[at + 2] == 30);
}

TEST(Statistics, CountsWhatIsNoLuminance) {
    std::vector<float> rgb;
    for (int i = 1; i <= 100; ++i) rgb.insert(rgb.end(), 3, float(i));
    for (const float odd : {0.0f, -5.0f, kNan, kInfinity}) rgb.insert(rgb.end(), 3, odd);
    const apps::LuminanceStatistics s = apps::luminance_statistics(rgb, 3);
    EXPECT_EQ(s.finite, 102u);
    EXPECT_EQ(s.non_finite, 2u);
    EXPECT_EQ(s.negative, 1u);
    EXPECT_EQ(s.zero, 1u);
    EXPECT_NEAR(s.least_positive, 1, 1e-6);
    EXPECT_NEAR(s.minimum, -5, 1e-5);
    EXPECT_NEAR(s.maximum, 100, 1e-4);
    for (const auto& [percent, value] : s.percentiles)
        if (percent == 50) {
            EXPECT_NEAR(value, 50, 1.01);
        }
    std::vector<float> rgba;
    for (int i = 1; i <= 100; ++i) rgba.insert(rgba.end(), {float(i), float(i), float(i), 7.0f});
    EXPECT_NEAR(apps::luminance_statistics(rgba).mean, 50.5, 1e-4);
    EXPECT_EQ(apps::luminance_statistics(rgba).negative, 0u);
}

TEST(Columns, CountCharactersNotBytes) {
    EXPECT_EQ(apps::column("abc", 5), "abc  ");
    EXPECT_EQ(apps::column("abcdef", 3), "abc");
    EXPECT_EQ(apps::column("\u00e9\u00e9\u00e9", 2), "\u00e9\u00e9");
}

}  // namespace
}  // namespace vesper::test
