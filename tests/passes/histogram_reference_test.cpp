// Counting in double. SPDX-License-Identifier: MIT
#include "passes/histogram_reference.h"

#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace vesper::reference {
namespace {

/// 100 bins of a tenth of a decade from 1e-4 to 1e6 cd/m^2.
shared::HistogramPush tenths(shared::uvec2 image, uint32_t level) {
    const uint32_t side = 1u << level;
    return {image,
            {(image.x + side - 1) / side, (image.y + side - 1) / side},
            level,
            100,
            float(std::log(1e-4)),
            float(10 / std::log(10.0))};
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
        const auto got = histogram(std::span<const dvec4>(texels.texels), tenths({w, h}, level)).exact;
        EXPECT_EQ(got.finite + got.non_finite, w * h);
        EXPECT_EQ(got.non_finite, 305u);
        EXPECT_EQ(std::accumulate(std::begin(got.count), std::end(got.count), 0u), got.finite);
    }
}

TEST(HistogramReference, TexelsVoteWithTheirFinitePixels) {
    const auto p = tenths({3, 3}, 1);
    const std::vector<dvec4> level{{1.05, 4, 0, 0}, {1.05, 1, 0, 0}, {105, 2, 0, 0}, {0, 0, 0, 0}};
    const auto got = histogram(std::span<const dvec4>(level), p).exact;
    EXPECT_EQ(got.count[40], 5u);
    EXPECT_EQ(got.count[60], 2u);
    EXPECT_EQ(got.finite, 7u);
    EXPECT_EQ(got.non_finite, 2u);  // one of the second texel's two, and the corner pixel
}

TEST(HistogramReference, AVoteAtAnEdgeMayFallOnEitherSideAndNoOther) {
    const auto p = tenths({4, 2}, 1);
    const std::vector<dvec4> level{{1.0, 4, 0, 0}, {30, 4, 0, 0}};
    const auto bounds = histogram(std::span<const dvec4>(level), p, 1e-3);
    shared::Histogram got = bounds.exact;
    EXPECT_TRUE(bounds.admits(got));
    std::swap(got.count[39], got.count[40]);
    EXPECT_TRUE(bounds.admits(got));
    got.count[39] = got.count[40] = 4;
    EXPECT_FALSE(bounds.admits(got)) << "voted twice";
    got = bounds.exact;
    std::swap(got.count[54], got.count[55]);
    EXPECT_FALSE(bounds.admits(got)) << "30 cd/m^2 is well within a bin";
}

}  // namespace
}  // namespace vesper::reference
