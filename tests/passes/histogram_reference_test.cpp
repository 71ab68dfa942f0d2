// Counting in double. SPDX-License-Identifier: MIT
#include "passes/histogram_reference.h"

#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace vesper::reference::histogram_reference_test {
namespace {

/// 100 bins of a tenth of a decade from 1e-4 to 1e6 cd/m^2. One vote per pixel.
shared::HistogramPush tenths(shared::uvec2 image, uint32_t level, bool split = false) {
    const uint32_t side = 1u << level;
    return {image,
            {(image.x + side - 1) / side, (image.y + side - 1) / side},
            level,
            100,
            float(std::log(1e-4)),
            float(10 / std::log(10.0)),
            1,
            split ? 1u : 0u,
            1};
}

Votes histogram(const std::vector<dvec4>& level, const shared::HistogramPush& p) {
    Votes votes;
    vote(votes, std::span<const dvec4>(level), p);
    return votes;
}

TEST(HistogramReference, ATenthOfADecadePerBin) {
    const auto p = tenths({2, 2}, 1);
    EXPECT_EQ(bin_at(bin_position(1.05, p), 100), 40u);
    EXPECT_EQ(bin_at(bin_position(1.05e-4, p), 100), 0u);
    EXPECT_EQ(bin_at(bin_position(0.95e6, p), 100), 99u);
    for (uint32_t i = 0; i < 100; ++i) EXPECT_EQ(bin_at(bin_position(std::pow(10, -4 + (i + 0.5) / 10), p), 100), i);
}

TEST(HistogramReference, WhatLiesOutsideCountsInTheEndBins) {
    const auto p = tenths({2, 2}, 1);
    for (double dark : {0.0, -5.0, 1e-30}) EXPECT_EQ(bin_at(bin_position(dark, p), 100), 0u);
    EXPECT_EQ(bin_at(bin_position(1e30, p), 100), 99u);
}

TEST(HistogramReference, EachPixelVotesOnce) {
    const uint32_t w = 61, h = 35;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> decades(-6, 9);
    std::vector<dvec3> image(w * h);
    for (dvec3& p : image) p = dvec3(std::pow(10, decades(random)));
    for (size_t i = 0; i < image.size(); i += 7) image[i].y = std::numeric_limits<double>::quiet_NaN();
    for (uint32_t level = 1; level <= 6; ++level) {
        const PyramidLevel texels = pyramid_level(std::span<const dvec3>(image), w, h, level);
        for (bool split : {false, true}) {
            const Votes got = histogram(texels.texels, tenths({w, h}, level, split));
            EXPECT_EQ(got.counted.finite + got.counted.non_finite, w * h);
            EXPECT_EQ(got.counted.non_finite, 305u);
            EXPECT_EQ(got.counted.votes, got.counted.finite);
            EXPECT_NEAR(std::accumulate(got.count.begin(), got.count.end(), 0.0), got.counted.finite, 1e-9);
        }
    }
}

TEST(HistogramReference, TexelsVoteForTheirFinitePixels) {
    const std::vector<dvec4> level{{1.05, 4, 0, 0}, {1.05, 1, 0, 0}, {105, 2, 0, 0}, {0, 0, 0, 0}};
    const Votes got = histogram(level, tenths({3, 3}, 1));
    EXPECT_EQ(got.count[40], 5);
    EXPECT_EQ(got.count[60], 2);
    EXPECT_EQ(got.counted.finite, 7u);
    EXPECT_EQ(got.counted.non_finite, 2u);  // one of the second texel's two, and the corner pixel
}

TEST(HistogramReference, VotesAreSharedByTheNearestTwo) {
    const double middle = std::pow(10, 0.05), edge = 1, quarter = std::pow(10, 0.075);  // of bin 40
    const Votes got = histogram({{middle, 4, 0, 0}}, tenths({2, 2}, 1, true));
    EXPECT_NEAR(got.count[40], 4, 1e-5);
    const Votes two = histogram({{edge, 4, 0, 0}}, tenths({2, 2}, 1, true));
    EXPECT_NEAR(two.count[39], 2, 1e-5);
    EXPECT_NEAR(two.count[40], 2, 1e-5);
    const Votes three = histogram({{quarter, 4, 0, 0}}, tenths({2, 2}, 1, true));
    EXPECT_NEAR(three.count[40], 3, 1e-5);
    EXPECT_NEAR(three.count[41], 1, 1e-5);
    for (double outside : {0.0, 1e-9, 1.01e-4})
        EXPECT_EQ(histogram({{outside, 4, 0, 0}}, tenths({2, 2}, 1, true)).count[0], 4) << outside;
    for (double outside : {0.99e6, 1e30})
        EXPECT_EQ(histogram({{outside, 4, 0, 0}}, tenths({2, 2}, 1, true)).count[99], 4) << outside;
}

// A pixel counts in as many overlapping texels wherever it is; an edge gives the same votes, within the width of a
// finer texel, wherever it is.
TEST(HistogramReference, OverlappingTexelsHaveNoGrid) {
    const auto level_of = [](uint32_t edge) {
        std::vector<dvec3> image;
        for (uint32_t i = 0; i < 256 * 3; ++i) image.emplace_back(dvec3(i % 256 < edge ? 0.01 : 300));
        return pyramid_level(std::span<const dvec3>(image), 256, 3, 2);
    };
    const auto between = [](const PyramidLevel& level) {  // pixels of texels across the edge, over all
        double some = 0, all = 0;
        for (const dvec4& t : level.texels) some += t.x > 0.0101 && t.x < 299 ? t.y : 0, all += t.y;
        return some / all;
    };
    double least = 1, most = 0;
    for (uint32_t edge = 100; edge < 132; ++edge) {
        const PyramidLevel texels = overlapping(level_of(edge), 8);
        double pixels = 0;
        for (const dvec4& t : texels.texels) pixels += t.y;
        EXPECT_EQ(pixels, 64.0 * 256 * 3);
        least = std::min(least, between(texels)), most = std::max(most, between(texels));
    }
    EXPECT_NEAR(least, 7.5 / 64, 0.6 / 64) << "texels of 32 pixels, of 256";
    EXPECT_NEAR(most, 7.5 / 64, 0.6 / 64);
}

TEST(HistogramReference, AdmitsRoundingAndNothingElse) {
    const Votes votes = histogram({{1.05, 4, 0, 0}, {30, 4, 0, 0}}, tenths({4, 2}, 1));
    shared::Histogram got = votes.counted;
    got.count[40] = 4, got.count[54] = 4;
    EXPECT_TRUE(votes.admits(got, 0.5));
    got.count[54] = 3, got.count[55] = 1;
    EXPECT_FALSE(votes.admits(got, 0.5));
    EXPECT_TRUE(votes.admits(got, 1));
    got.count[55] = 2;
    EXPECT_FALSE(votes.admits(got, 2)) << "voted twice";
}

}  // namespace
}  // namespace vesper::reference::histogram_reference_test
