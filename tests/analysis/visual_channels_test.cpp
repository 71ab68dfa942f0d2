// Channels of gratings against closed forms, and sums of channels. SPDX-License-Identifier: MIT
#include "analysis/visual_channels.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/complaints.h"
#include "support/gratings.h"

namespace vesper::test {
namespace {

using analysis::Channel, analysis::PicturePair;

constexpr uint32_t kChannelSide = 256;
constexpr double kChannelsPerDegree = 32;  // px

// Mean of the squared responses to the first picture in its middle, of each channel.
std::vector<double> squares_of(const std::vector<float>& picture) {
    std::vector<double> squares;
    analysis::visit_channels({kChannelSide, kChannelSide, kChannelsPerDegree, picture, picture}, analysis::JndScale({}),
                             [&](const Channel& channel) {
                                 const uint32_t n = kChannelSide / channel.grid.step;
                                 double sum = 0, samples = 0;
                                 for (uint32_t y = n / 4; y < 3 * n / 4; ++y)
                                     for (uint32_t x = n / 4; x < 3 * n / 4; ++x)
                                         sum += std::norm(channel.first[size_t{y} * channel.grid.width + x]), ++samples;
                                 squares.push_back(channel.band == Channel::Band::Below ? 0 : sum / samples);
                             });
    return squares;
}

// A grating of the middle frequency and orientation of a channel is at its threshold there, and in its neighbours by
// the cube of the cosine of 45 degrees.
TEST(VisualChannels, RespondWithTheContrastInThresholds) {
    for (const auto& [u, v] : {std::pair{0.0, 16.0}, {16.0, 0.0}, {32.0, 0.0}}) {
        const double frequency = std::hypot(u, v) * kChannelsPerDegree / kChannelSide, mean = 2;
        ASSERT_EQ(std::fmod(std::log2(16 / frequency), 1), 0) << "the middle of an octave";
        const double contrast = 1 / analysis::contrast_sensitivity(frequency, mean);
        double largest = 0, sum = 0;
        for (const double square : squares_of(grating(kChannelSide, u, v, mean, contrast)))
            largest = std::max(largest, square), sum += square;
        // Squared share of the grating's channel of what four orientations have: 1 / (5/4). Luminance is on a curve.
        EXPECT_NEAR(largest * 5 / 4, 1, 0.02) << u << ", " << v;
        EXPECT_NEAR(sum, 1, 0.02) << "squares of all channels";
    }
}

// Between octaves and orientations the squares sum to the same: no grating falls between channels.
TEST(VisualChannels, SquaresSumToThatOfAnyGrating) {
    for (const auto& [u, v] : {std::pair{23.0, 0.0}, {9.0, 5.0}, {20.0, 20.0}, {12.0, -31.0}, {50.0, 7.0}}) {
        const double frequency = std::hypot(u, v) * kChannelsPerDegree / kChannelSide, mean = 30;
        const double contrast = 2 / analysis::contrast_sensitivity(frequency, mean);
        double sum = 0;
        for (const double square : squares_of(grating(kChannelSide, u, v, mean, contrast))) sum += square;
        // Between the octaves' middles sensitivity to a place's own luminance is that of the middle; the mirrored
        // margin bends waves that do not fit.
        EXPECT_NEAR(sum, 4, 0.2) << u << ", " << v;
    }
}

TEST(VisualChannels, UniformPicturesHaveNoContrast) {
    for (const double square : squares_of(grating(kChannelSide, 0, 0, 5, 0))) EXPECT_LT(square, 1e-18);
}

// Luminances of sides as small as these have channels, too, and what is not a number is black.
TEST(VisualChannels, TakeAnyPicture) {
    const analysis::JndScale scale({});
    for (const auto& size : {std::pair{1u, 1u}, {1u, 37u}, {41u, 3u}, {13u, 11u}})
        for (const double per_degree : {0.01, 3.0, 27.0, 1000.0}) {
            std::vector<float> damaged(size_t{size.first} * size.second, 1);
            damaged[0] = std::nanf(""), damaged[damaged.size() / 2] = -HUGE_VALF;
            size_t channels = 0;
            analysis::visit_channels({size.first, size.second, per_degree, damaged, damaged}, scale,
                                     [&](const Channel& c) {
                                         ++channels;
                                         ASSERT_GE(c.grid.width * c.grid.step, size.first);
                                         for (size_t i = 0; i < c.grid.size(); ++i) {
                                             ASSERT_TRUE(std::isfinite(std::abs(c.first[i])));
                                             ASSERT_EQ(c.first[i], c.second[i]);
                                         }
                                     });
            EXPECT_GE(channels, 6u);
        }
}

TEST(VisualChannels, RefusePicturesThatCannotBeCompared) {
    const std::vector<float> four(4, 1), three(3, 1);
    const auto none = [](const Channel&) {};
    const auto said = [&](const PicturePair& pair) {
        return complaint_of([&] { analysis::visit_channels(pair, analysis::JndScale({}), none); });
    };
    EXPECT_TRUE(contains(said({2, 2, 10, four, three}), "differ in size"));
    EXPECT_TRUE(contains(said({2, 2, 0, four, four}), "angle"));
    EXPECT_TRUE(contains(said({0, 2, 10, {}, {}}), "pixels"));
}

TEST(ChannelSum, IsLinearBetweenSamples) {
    analysis::ChannelSum sum;
    sum.at({2, 2, 2}) = {1, 3, 5, 7};
    sum.at({4, 4, 1})[0] += 10;
    // Three of four columns and rows.
    EXPECT_EQ(sum.pixels(3, 3), (std::vector<double>{11, 2, 3, 3, 4, 5, 5, 6, 7}));
}

TEST(Detection, IsHalfAtTheThreshold) {
    EXPECT_NEAR(analysis::detection_probability(analysis::power_of_contrast(1)), 0.5, 1e-15);
    EXPECT_NEAR(analysis::detection_probability(analysis::power_of_contrast(-2)), 1 - std::pow(2, -std::pow(2, 3.5)),
                1e-15);
    EXPECT_EQ(analysis::detection_probability(0), 0);
}

}  // namespace
}  // namespace vesper::test
