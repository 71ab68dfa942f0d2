// Thresholds, water-filling and the tone curve, against published digits and properties. SPDX-License-Identifier: MIT
#include "passes/adapt_reference.h"

#include <random>

#include <gtest/gtest.h>

namespace vesper::reference {
namespace {

constexpr uint32_t kBins = 100;

shared::AdaptPush push_of(double low = 0.5, double high = 200) {
    shared::AdaptPush p{};
    p.bins = kBins;
    p.ln_low = float(std::log(1e-4)), p.bins_per_ln = float(10 / std::log(10.0));  // tenths of a decade
    p.display_low = float(low), p.display_high = float(high);
    p.key = 0.18f;
    return p;
}

/// Votes spread like a night street: a broad dark hill, a few bright lamps.
shared::Histogram night(uint32_t seed = 1) {
    shared::Histogram histogram{};
    std::mt19937 random(seed);
    std::normal_distribution<double> road(30, 8), lamps(85, 3);
    for (int i = 0; i < 20000; ++i) {
        const double at = i % 100 == 0 ? lamps(random) : road(random);
        ++histogram.count[uint32_t(std::clamp(at, 0.0, kBins - 1.0))];
        ++histogram.finite;
    }
    return histogram;
}

/// All votes in a few neighbouring bins: fog, or an evenly lit day.
shared::Histogram fog(uint32_t from, uint32_t to) {
    shared::Histogram histogram{};
    for (uint32_t i = from; i <= to; ++i) histogram.count[i] = 100, histogram.finite += 100;
    return histogram;
}

// The table in tone-mapping.md, 1.1, computed there from Ferwerda et al. 1996.
TEST(AdaptReference, ConeThresholdsArePublished) {
    const std::pair<double, double> table[]{{-4, 0.190546},   {-3, 0.190546}, {-2, 0.193277}, {-1, 0.231643},
                                            {-0.5, 0.285768}, {0, 0.391302},  {1, 1.07190},   {1.5, 2.21169},
                                            {2, 5.55904},     {3, 55.5904},   {4, 555.904}};
    for (auto [log10_luminance, threshold] : table)
        EXPECT_NEAR(cone_threshold(std::pow(10, log10_luminance)) / threshold, 1, 5e-6) << log10_luminance;
    EXPECT_NEAR(cone_threshold(5000) / 5000, std::pow(10, -1.255), 1e-12) << "Weber's law";
}

// The toy of tone-mapping.md, 2.8.
TEST(AdaptReference, FillsTheRangeUnderTheCeilings) {
    const std::vector<double> h{0.5, 0.3, 0.1, 0.1, 0}, c{1, 0.5, 2, 0.2, 1};
    const std::pair<double, std::vector<double>> cases[]{
        {0.6, {0.6, 0.36, 0.12, 0.12, 0}}, {0.8, {0.8, 0.48, 0.16, 0.16, 0}}, {1.2, {1, 0.5, 0.7, 0.2, 0}}};
    for (const auto& [range, want] : cases) {
        const Slopes got = fill(h, c, 0.5, range);
        EXPECT_FALSE(got.under);
        for (size_t i = 0; i < h.size(); ++i)
            EXPECT_NEAR(got.s[i], want[i], 1e-12) << "range " << range << " bin " << i;
    }
    const Slopes all = fill(h, c, 0.5, 2.0);
    EXPECT_TRUE(all.under);
    EXPECT_EQ(all.s, (std::vector<double>{1, 0.5, 2, 0.2, 0}));
    EXPECT_NEAR(all.slack, 2.0 - 0.5 * 3.7, 1e-12);
}

TEST(AdaptReference, FillIsExactForAnyCeilings) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int k = 0; k < 200; ++k) {
        std::vector<double> h(40), c(40);
        double sum = 0;
        for (size_t i = 0; i < h.size(); ++i) {
            h[i] = uniform(random) < 0.3 ? 0 : std::pow(uniform(random), 4), sum += h[i];
            c[i] = std::exp(4 * uniform(random) - 2);
        }
        for (double& x : h) x /= sum;
        double ceiling = 0;
        for (size_t i = 0; i < h.size(); ++i) ceiling += h[i] > 0 ? c[i] * 0.1 : 0;
        const double range = ceiling * 1.2 * uniform(random);
        const Slopes got = fill(h, c, 0.1, range);
        EXPECT_EQ(got.under, range > ceiling);
        double filled = 0, lambda = -1;
        for (size_t i = 0; i < h.size(); ++i) {
            filled += got.s[i] * 0.1;
            EXPECT_LE(got.s[i], c[i] * (1 + 1e-12));
            if (h[i] > 0 && got.s[i] < c[i] * (1 - 1e-9)) {  // below its ceiling: proportional to the votes
                if (lambda < 0) lambda = got.s[i] / h[i];
                EXPECT_NEAR(got.s[i] / h[i] / lambda, 1, 1e-9);
            }
        }
        EXPECT_NEAR(filled + got.slack, range, 1e-10);
    }
}

/// Ward Larson et al. 1997, section 4.4, to the end: clip counts to T delta c / D, again with the new total T.
std::vector<double> ward(std::vector<double> f, const std::vector<double>& c, double delta, double range, int rounds) {
    for (int k = 0; k < rounds; ++k) {
        const double total = std::accumulate(f.begin(), f.end(), 0.0);
        for (size_t i = 0; i < f.size(); ++i) f[i] = std::min(f[i], total * delta * c[i] / range);
    }
    const double total = std::accumulate(f.begin(), f.end(), 0.0);
    for (double& x : f) x *= range / (total * delta);
    return f;
}

TEST(AdaptReference, FillIsTheFixedPointOfWardsClipping) {
    const std::vector<double> h = fractions(night(), kBins);
    std::vector<double> c(kBins);
    for (uint32_t i = 0; i < kBins; ++i) c[i] = 0.35 + 0.3 * std::sin(i * 0.4);
    const double delta = std::log(10.0) / 10;
    const Slopes exact = fill(h, c, delta, 5);
    ASSERT_FALSE(exact.under);
    const std::vector<double> clipped = ward(h, c, delta, 5, 20000);
    for (uint32_t i = 0; i < kBins; ++i) EXPECT_NEAR(clipped[i], exact.s[i], 1e-4) << i;
}

TEST(AdaptReference, ALittleIsSpreadOverTheOccupiedRange) {
    shared::Histogram histogram{};
    histogram.count[10] = 3, histogram.count[14] = 1, histogram.finite = 4;
    const std::vector<double> h = fractions(histogram, kBins);
    EXPECT_NEAR(std::accumulate(h.begin(), h.end(), 0.0), 1, 1e-15);
    EXPECT_NEAR(h[10], (0.75 + 2e-5) / 1.0001, 1e-15);
    EXPECT_NEAR(h[12], 2e-5 / 1.0001, 1e-15);
    EXPECT_EQ(h[9], 0);
    EXPECT_EQ(h[15], 0);
}

TEST(AdaptReference, CurveIsMonotoneAndFillsTheDisplay) {
    const shared::AdaptPush p = push_of();
    for (uint32_t seed : {1u, 2u, 3u}) {
        const Adjusted a = adjust(fractions(night(seed), kBins), 0.3, p);
        EXPECT_FALSE(a.under);
        EXPECT_NEAR(a.curve.node.front(), std::log(0.5), 1e-12);
        EXPECT_NEAR(a.curve.node.back(), std::log(200), 1e-6);
        for (size_t i = 0; i < kBins; ++i) EXPECT_GE(a.curve.node[i + 1], a.curve.node[i]);
    }
}

// Ward's condition, the reason for it all: nothing becomes visible that was not: dLd / dL <= T(Ld) / T(L).
TEST(AdaptReference, NoBinIsSteeperThanItsCeiling) {
    const shared::AdaptPush p = push_of();
    const double delta = 1 / double(p.bins_per_ln);
    for (uint32_t seed : {1u, 2u, 3u}) {
        const Adjusted a = adjust(fractions(night(seed), kBins), 0.3, p);
        for (uint32_t i = 0; i < kBins; ++i) {
            const double scene = std::exp(p.ln_low + (i + 0.5) * delta);
            const double shown = std::exp((a.curve.node[i] + a.curve.node[i + 1]) / 2);
            const double ceiling = (cone_threshold(shown) / shown) / (cone_threshold(scene) / scene);
            EXPECT_LE((a.curve.node[i + 1] - a.curve.node[i]) / delta, ceiling * 1.001 + 1e-9) << "bin " << i;
        }
    }
}

// Day on a day display: both in Weber's region, so that no contrast is stretched: slope 1, and white matched.
TEST(AdaptReference, FogKeepsItsContrastAndSitsWhereItIsVisible) {
    const shared::AdaptPush p = push_of(100, 20000);
    const double la = std::pow(10, 3.45);  // bins 73 to 75: 10^3.3 to 10^3.6 cd/m^2
    const Adjusted a = adjust(fractions(fog(73, 75), kBins), la, p);
    EXPECT_TRUE(a.under);
    const double delta = 1 / double(p.bins_per_ln);
    EXPECT_NEAR(a.slack, std::log(200) - 3 * delta, 1e-4);
    for (size_t i = 73; i <= 75; ++i) EXPECT_NEAR(a.curve.node[i + 1] - a.curve.node[i], delta, 1e-4);
    // T_c(10000) / T_c(La) La = 10000 there: La is shown at half of white.
    EXPECT_NEAR(std::exp(a.curve.at(std::log(la))), 10000, 10);
}

TEST(AdaptReference, FogIsMovedNoFartherThanTheDisplayAllows) {
    const shared::AdaptPush p = push_of(0.5, 50);
    for (uint32_t bin : {2u, 20u, 60u, 95u}) {
        const Adjusted a = adjust(fractions(fog(bin, bin), kBins), std::pow(10, -3.95 + 0.1 * bin), p);
        EXPECT_TRUE(a.under) << bin;
        EXPECT_GE(a.curve.node.front(), std::log(0.5) - 1e-9);
        EXPECT_LE(a.curve.node.back(), std::log(50) + 1e-5);
    }
}

TEST(AdaptReference, CurveIsFlatBeyondItsEndsAndLinearBetweenNodes) {
    const Curve curve{0, 1, {1, 3, 4}};
    EXPECT_EQ(curve.at(-5), 1);
    EXPECT_EQ(curve.at(0.25), 1.5);
    EXPECT_EQ(curve.at(1.5), 3.5);
    EXPECT_EQ(curve.at(2), 4);
    EXPECT_EQ(curve.at(9), 4);
}

// Reinhard et al. 2002 with the luminances of tone-mapping.md, section 5: 0.01 to 1000 cd/m^2 in decades.
TEST(AdaptReference, ReinhardParameters) {
    const dvec4 top(185.185, 6, std::log(10) / 2, 1000);
    shared::AdaptPush p = push_of();
    p.seconds = 0.25f;
    const Adapted a = adapt(night(), top, {7, 1.5f}, p);
    EXPECT_NEAR(a.tone.log_average, std::sqrt(10), 1e-6);
    EXPECT_EQ(a.tone.adaptation, a.tone.log_average);
    EXPECT_NEAR(a.tone.reinhard_scale, 0.18 / std::sqrt(10), 1e-8);
    EXPECT_NEAR(a.tone.reinhard_white, 1 / std::pow(1000 * 0.18 / std::sqrt(10), 2), 1e-10);
    EXPECT_NEAR(a.tone.linear_gain, 1e-3, 1e-9) << "linear_high 0: up to the maximum";
    EXPECT_EQ(a.eye.adaptation, a.tone.adaptation);
    EXPECT_FLOAT_EQ(a.eye.seconds, 1.75f);

    p.white = 50, p.linear_low = 1, p.linear_high = 5;
    const Adapted b = adapt(night(), top, {}, p);
    EXPECT_NEAR(b.tone.reinhard_white, 1 / std::pow(50 * 0.18 / std::sqrt(10), 2), 1e-7);
    EXPECT_FLOAT_EQ(b.tone.linear_gain, 0.25f);
}

TEST(AdaptReference, AnEmptyFrameIsBlack) {
    const Adapted a = adapt({}, dvec4(0), {}, push_of());
    for (uint32_t i = 0; i <= kBins; ++i) EXPECT_NEAR(a.tone.node[i], std::log(0.5), 1e-7);
    EXPECT_FLOAT_EQ(a.tone.log_average, 1e-4f);
    EXPECT_TRUE(std::isfinite(a.tone.reinhard_white));
    EXPECT_TRUE(std::isfinite(a.tone.linear_gain));
}

// Twice the pixels in every bin is the same picture.
TEST(AdaptReference, OnlyTheShapeOfTheHistogramMatters) {
    shared::Histogram once = night(), twice = once;
    twice.finite *= 2;
    for (uint32_t& n : twice.count) n *= 2;
    const Adjusted a = adjust(fractions(once, kBins), 1, push_of()), b = adjust(fractions(twice, kBins), 1, push_of());
    for (size_t i = 0; i <= kBins; ++i) EXPECT_DOUBLE_EQ(a.curve.node[i], b.curve.node[i]);
}

}  // namespace
}  // namespace vesper::reference
