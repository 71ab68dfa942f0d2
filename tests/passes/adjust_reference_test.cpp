// Filling under ceilings and trimming, against published digits and properties. SPDX-License-Identifier: MIT
#include "passes/adjust_reference.h"

#include <gtest/gtest.h>

#include "support/histograms.h"

namespace vesper::reference::adjust_reference_test {
namespace {

/// Infinite lambda: Ward's own fixed point.
constexpr double kNoLimit = 1e30;

// The toy of tone-mapping.md, 2.8.
TEST(AdjustReference, FillsTheRangeUnderTheCeilings) {
    const std::vector<double> h{0.5, 0.3, 0.1, 0.1, 0}, c{1, 0.5, 2, 0.2, 1};
    const std::pair<double, std::vector<double>> cases[]{
        {0.6, {0.6, 0.36, 0.12, 0.12, 0}}, {0.8, {0.8, 0.48, 0.16, 0.16, 0}}, {1.2, {1, 0.5, 0.7, 0.2, 0}}};
    for (const auto& [range, want] : cases) {
        const Slopes got = fill(h, c, 0.5, range, kNoLimit);
        EXPECT_FALSE(got.under);
        for (size_t i = 0; i < h.size(); ++i)
            EXPECT_NEAR(got.s[i], want[i], 1e-12) << "range " << range << " bin " << i;
    }
    const Slopes all = fill(h, c, 0.5, 2.0, kNoLimit);
    EXPECT_TRUE(all.under);
    EXPECT_EQ(all.s, (std::vector<double>{1, 0.5, 2, 0.2, 0}));
    EXPECT_NEAR(all.slack, 2.0 - 0.5 * 3.7, 1e-12);
}

TEST(AdjustReference, FillIsExactForAnyCeilings) {
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
        const Slopes got = fill(h, c, 0.1, range, kNoLimit);
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

TEST(AdjustReference, FillIsTheFixedPointOfWardsClipping) {
    const std::vector<double> h = shares(night(), kBins);
    std::vector<double> c(kBins);
    for (uint32_t i = 0; i < kBins; ++i) c[i] = 0.35 + 0.3 * std::sin(i * 0.4);
    const double delta = std::log(10.0) / 10;
    const Slopes exact = fill(h, c, delta, 5, kNoLimit);
    ASSERT_FALSE(exact.under);
    const std::vector<double> clipped = ward(h, c, delta, 5, 20000);
    for (uint32_t i = 0; i < kBins; ++i) EXPECT_NEAR(clipped[i], exact.s[i], 1e-4) << i;
}

TEST(AdjustReference, CurveIsFlatBeyondItsEndsAndLinearBetweenNodes) {
    const Curve curve{0, 1, {1, 3, 4}};
    EXPECT_EQ(curve.at(-5), 1);
    EXPECT_EQ(curve.at(0.25), 1.5);
    EXPECT_EQ(curve.at(1.5), 3.5);
    EXPECT_EQ(curve.at(2), 4);
    EXPECT_EQ(curve.at(9), 4);
}

// What trimming stops at is the solution for its own ceilings, within twice its tolerance of 2.5 % of the total, since
// the ceilings are of a curve that is off by as much: 0.05 in log10 here.
TEST(AdjustReference, TrimmedCurvesAreNearTheSolvedOnes) {
    for (uint32_t ceiling : {shared::kCeilingHuman, shared::kCeilingLinear})
        for (uint32_t seed : {1u, 2u, 3u}) {
            const auto p = parameters_of(1, 100, ceiling);
            const Thresholds t = thresholds_of(p, kCones, 1, kRods, 1);
            shared::Histogram histogram = night(seed);
            if (seed == 3)
                for (uint32_t i = 10; i < 70; ++i)
                    histogram.count[i] += 150, histogram.finite += 150, histogram.votes += 150;
            const Adjusted trimmed = trim(shares(histogram, kBins), 1, t, p);
            EXPECT_FALSE(trimmed.under);
            const double delta = 1 / double(p.bins_per_ln);
            std::vector<double> c;
            for (uint32_t i = 0; i < kBins; ++i) {
                const double scene = std::exp(p.ln_low + (i + 0.5) * delta),
                             shown = std::exp((trimmed.curve.node[i] + trimmed.curve.node[i + 1]) / 2);
                c.push_back(t.display(shown) / shown / (t.scene(scene) / scene));
            }
            const Slopes solved = fill(shares(histogram, kBins), c, delta, std::log(100), kNoLimit);
            double node = 0;
            for (uint32_t i = 0; i < kBins; ++i) {
                node += solved.s[i] * delta;
                EXPECT_NEAR(node / std::log(10), trimmed.curve.node[i + 1] / std::log(10), 0.05)
                    << "ceiling " << ceiling << " seed " << seed << " node " << i;
            }
        }
}

// Without anything to clip the curve is plain equalization; with a range that fits, or nothing left, a linear scale
// (tone-mapping.md, section 3).
TEST(AdjustReference, TrimmingHasItsEndsRight) {
    const auto p = parameters_of(1, 100, shared::kCeilingHuman);
    const Thresholds t = thresholds_of(p, kCones, 1, kRods, 1);
    std::vector<double> even(kBins, 0.0), narrow = even;
    for (uint32_t i = 30; i < 90; ++i) even[i] = 1.0 / 60;
    for (uint32_t i = 60; i < 70; ++i) narrow[i] = 0.1;
    const Adjusted equalized = trim(even, 1, {[](double) { return 1e-9; }, [](double) { return 1.0; }}, p);
    for (uint32_t i = 30; i <= 90; ++i) EXPECT_NEAR(equalized.curve.node[i], std::log(100) * (i - 30) / 60, 1e-12);
    const Adjusted linear = trim(narrow, 200, t, p);
    EXPECT_TRUE(linear.under);
    const double scale = vision::human_threshold(10) / vision::human_threshold(200);
    for (uint32_t i = 60; i <= 70; ++i)
        EXPECT_NEAR(linear.curve.node[i], std::log(std::pow(10, -4 + 0.1 * i) * scale), 1e-5);
    EXPECT_EQ(linear.curve.node[100], std::log(100));
    EXPECT_TRUE(trim(even, 1, {[](double) { return 1e9; }, [](double) { return 1.0; }}, p).under)
        << "nothing can be seen";
}

// A street with spikes (sky, road, signs) and a tail of lamps. Fewer bins see the same through the same window.
TEST(AdjustReference, FewBinsGiveTheCurveOfMany) {
    std::vector<std::pair<double, double>> votes{
        {std::log(0.0202), 0.16}, {std::log(0.7), 0.05}, {std::log(95), 0.003}, {std::log(8000), 0.002}};
    std::mt19937 random(5);
    std::normal_distribution<double> road(std::log(1.6), 0.6), lamps(std::log(300), 2);
    for (int i = 0; i < 20000; ++i) votes.push_back({i % 20 == 0 ? lamps(random) : road(random), 0.785 / 20000});
    for (const uint32_t ceiling : {shared::kCeilingEye, shared::kCeilingHuman}) {
        const Curve finest = curve_of_votes(votes, 0.5, split_parameters(256, ceiling)).curve;
        for (const uint32_t bins : {90u, 100u, 128u, 160u, 200u}) {
            const Curve few = curve_of_votes(votes, 0.5, split_parameters(bins, ceiling)).curve;
            for (double ln = std::log(1e-3); ln < std::log(1e5); ln += 0.02) {
                const auto code = [&](const Curve& c) {
                    return 255 * std::pow((std::exp(c.at(ln)) - 0.12) / (100 - 0.12), 1 / 2.2);
                };
                EXPECT_NEAR(code(few), code(finest), 1) << bins << " bins, " << std::exp(ln) << " cd/m^2";
            }
        }
    }
}
}  // namespace
}  // namespace vesper::reference::adjust_reference_test
