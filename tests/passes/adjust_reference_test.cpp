// Water-filling and the tone curve, against published digits and properties. SPDX-License-Identifier: MIT
#include "passes/adjust_reference.h"

#include <gtest/gtest.h>

#include "support/histograms.h"

namespace vesper::reference {
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

// The curve that is climbed is the fixed point of Ward's clipping for the ceilings that belong to it.
TEST(AdjustReference, TheCurveIsAFixedPointOfItsCeilings) {
    for (uint32_t ceiling : {shared::kCeilingHuman, shared::kCeilingCones, shared::kCeilingLinear}) {
        const auto p = parameters_of(1, 100, ceiling);
        const Thresholds t = thresholds_of(p, kCones, 1, kRods, 1);
        const std::vector<double> h = with_spread(shares(night(2), kBins));
        const Adjusted a = adjust(shares(night(2), kBins), 1, t, p);
        EXPECT_FALSE(a.under);
        const double delta = 1 / double(p.bins_per_ln);
        std::vector<double> c;
        for (uint32_t i = 0; i < kBins; ++i) {
            const double scene = std::exp(p.ln_low + (i + 0.5) * delta), shown = std::exp((a.curve.node[i] + a.curve.node[i + 1]) / 2);
            c.push_back(t.display(shown) / shown / (t.scene(scene) / scene));
        }
        const Slopes filled = fill(h, c, delta, std::log(100), kNoLimit);
        // 1e-3: the middle of a bin is corrected three times.
        for (uint32_t i = 0; i < kBins; ++i) EXPECT_NEAR((a.curve.node[i + 1] - a.curve.node[i]) / delta, filled.s[i], 1e-3 * (1 + filled.s[i])) << i;
    }
}

TEST(AdjustReference, FillIsTheFixedPointOfWardsClipping) {
    const std::vector<double> h = with_spread(shares(night(), kBins));
    std::vector<double> c(kBins);
    for (uint32_t i = 0; i < kBins; ++i) c[i] = 0.35 + 0.3 * std::sin(i * 0.4);
    const double delta = std::log(10.0) / 10;
    const Slopes exact = fill(h, c, delta, 5, kNoLimit);
    ASSERT_FALSE(exact.under);
    const std::vector<double> clipped = ward(h, c, delta, 5, 20000);
    for (uint32_t i = 0; i < kBins; ++i) EXPECT_NEAR(clipped[i], exact.s[i], 1e-4) << i;
}

TEST(AdjustReference, ALittleIsSpreadOverAllBins) {
    std::vector<double> share(kBins, 0.0);
    EXPECT_EQ(with_spread(share), share) << "nobody has voted";
    share[10] = 0.75, share[14] = 0.25;
    const std::vector<double> h = with_spread(share);
    EXPECT_NEAR(std::accumulate(h.begin(), h.end(), 0.0), 1, 1e-14);
    EXPECT_NEAR(h[10], (0.75 + 1e-7) / 1.00001, 1e-15);
    EXPECT_NEAR(h[12], 1e-7 / 1.00001, 1e-15);
}

TEST(AdjustReference, CurveIsMonotoneAndFillsTheDisplay) {
    const shared::ToneParameters p = parameters_of();
    for (uint32_t seed : {1u, 2u, 3u}) {
        const Adjusted a = curve_of(night(seed), 0.3, p);
        EXPECT_FALSE(a.under);
        EXPECT_NEAR(a.curve.node.front(), std::log(0.5), 1e-12);
        EXPECT_NEAR(a.curve.node.back(), std::log(200), 1e-6);
        for (size_t i = 0; i < kBins; ++i) EXPECT_GE(a.curve.node[i + 1], a.curve.node[i]);
    }
}

// Ward's condition, the reason for it all: nothing becomes visible that was not: dLd / dL <= T(Ld) / T(L).
TEST(AdjustReference, NoBinIsSteeperThanItsCeiling) {
    const shared::ToneParameters p = parameters_of();
    const double delta = 1 / double(p.bins_per_ln);
    for (uint32_t seed : {1u, 2u, 3u}) {
        const Adjusted a = curve_of(night(seed), 0.3, p);
        for (uint32_t i = 0; i < kBins; ++i) {
            const double scene = std::exp(p.ln_low + (i + 0.5) * delta);
            const double shown = std::exp((a.curve.node[i] + a.curve.node[i + 1]) / 2);
            const double ceiling = (cone_threshold(shown) / shown) / (cone_threshold(scene) / scene);
            // 0.3 %: the ceiling is met along the bin, of a quarter of a unit of ln L, and is looked at here in its middle.
            EXPECT_LE((a.curve.node[i + 1] - a.curve.node[i]) / delta, ceiling * 1.003 + 1e-9) << "bin " << i;
        }
    }
}

// Day on a day display: both in Weber's region, so that no contrast is stretched: slope 1, and white matched.
TEST(AdjustReference, FogKeepsItsContrastAndSitsWhereItIsVisible) {
    const shared::ToneParameters p = parameters_of(100, 20000);
    const double la = std::pow(10, 3.45);  // bins 73 to 75: 10^3.3 to 10^3.6 cd/m^2
    const Adjusted a = curve_of(fog(73, 75), la, p);
    EXPECT_TRUE(a.under);
    const double delta = 1 / double(p.bins_per_ln);
    // The empty bins take up to 64 * 1e-7 of the range each.
    EXPECT_LE(a.slack, std::log(200) - 3 * delta);
    // 2e-4 a bin: steps of 0.23 in ln L, to the fourth order.
    EXPECT_GE(a.slack, std::log(200) * (1 - 97 * 64e-7) - 3 * delta - 6e-4);
    for (size_t i = 73; i <= 75; ++i) EXPECT_NEAR(a.curve.node[i + 1] - a.curve.node[i], delta, 2e-4);
    // T_c(10000) / T_c(La) La = 10000 there: La is shown at half of white.
    EXPECT_NEAR(std::exp(a.curve.at(std::log(la))), 10000, 10);
}

TEST(AdjustReference, FogIsMovedNoFartherThanTheDisplayAllows) {
    const shared::ToneParameters p = parameters_of(0.5, 50);
    for (uint32_t bin : {2u, 20u, 60u, 95u}) {
        const Adjusted a = curve_of(fog(bin, bin), std::pow(10, -3.95 + 0.1 * bin), p);
        EXPECT_TRUE(a.under) << bin;
        EXPECT_GE(a.curve.node.front(), std::log(0.5) - 1e-9);
        EXPECT_LE(a.curve.node.back(), std::log(50) + 1e-5);
    }
}

TEST(AdjustReference, CurveIsFlatBeyondItsEndsAndLinearBetweenNodes) {
    const Curve curve{0, 1, {1, 3, 4}};
    EXPECT_EQ(curve.at(-5), 1);
    EXPECT_EQ(curve.at(0.25), 1.5);
    EXPECT_EQ(curve.at(1.5), 3.5);
    EXPECT_EQ(curve.at(2), 4);
    EXPECT_EQ(curve.at(9), 4);
}

// What trimming stops at is the solved curve within its tolerance of 2.5 % of the total: 0.025 in log10 here.
TEST(AdjustReference, TrimmedCurvesAreNearTheSolvedOnes) {
    for (uint32_t ceiling : {shared::kCeilingHuman, shared::kCeilingLinear})
        for (uint32_t seed : {1u, 2u, 3u}) {
            const auto p = parameters_of(1, 100, ceiling);
            shared::Histogram histogram = night(seed);
            if (seed == 3)
                for (uint32_t i = 10; i < 70; ++i) histogram.count[i] += 150, histogram.finite += 150, histogram.votes += 150;
            const Adjusted solved = curve_of(histogram, 1, p);
            const Adjusted trimmed = trim(shares(histogram, kBins), 1, thresholds_of(p, kCones, 1, kRods, 1), p);
            EXPECT_FALSE(solved.under);
            EXPECT_FALSE(trimmed.under);
            for (size_t i = 0; i <= kBins; ++i)
                EXPECT_NEAR(solved.curve.node[i] / std::log(10), trimmed.curve.node[i] / std::log(10), 0.025) << "ceiling " << ceiling << " seed " << seed << " node " << i;
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
    const double scale = human_threshold(10) / human_threshold(200);
    for (uint32_t i = 60; i <= 70; ++i) EXPECT_NEAR(linear.curve.node[i], std::log(std::pow(10, -4 + 0.1 * i) * scale), 1e-5);
    EXPECT_EQ(linear.curve.node[100], std::log(100));
    EXPECT_TRUE(trim(even, 1, {[](double) { return 1e9; }, [](double) { return 1.0; }}, p).under) << "nothing can be seen";
}

// A hill of the histogram moves over the edges of bins in small steps: the curve moves with it, without a jump. Votes
// that are shared by two bins make that so.
TEST(AdjustReference, NothingJumpsAcrossTheEdgeOfABin) {
    const auto p = parameters_of(0.5, 200, shared::kCeilingEye);
    const Thresholds t = thresholds_of(p, kCones, kCones.adapted_sigma(1), kRods, kRods.adapted_sigma(1));
    std::vector<double> before;
    for (double at = 38; at < 40; at += 0.005) {
        std::vector<double> share(kBins, 0.0);
        for (int i = 0; i < 400; ++i) {  // 0.3 of the picture within half a decade, the rest over six
            const double x = at + 5 * i / 400.0;
            share[size_t(x)] += 0.3 / 400 * (1 - (x - std::floor(x))), share[size_t(x) + 1] += 0.3 / 400 * (x - std::floor(x));
        }
        for (uint32_t i = 20; i < 80; ++i) share[i] += 0.7 / 60;
        const Curve curve = adjust(share, 1, t, p).curve;
        for (size_t i = 0; i < curve.node.size() && !before.empty(); ++i)
            EXPECT_NEAR(curve.node[i], before[i], 0.005) << "0.1 % of luminance moved it by more than 0.5 %, at " << at << " node " << i;
        before = curve.node;
    }
}

// A few pixels of 1e5 cd/m^2 on 0.01 cd/m^2, nothing in between. The eye's ceilings allow 80 just noticeable differences, more
// than the display has: the lamp is white, the ground stays dark, and what lies between is in between, under its ceilings.
TEST(AdjustReference, ALampShinesOnDarkGround) {
    const shared::ToneParameters p = split_parameters(100);
    const Adjusted a = curve_of_votes({{std::log(0.01), 0.9996}, {std::log(1e5), 4e-4}}, 0.01, p);
    EXPECT_GE(std::exp(a.curve.at(std::log(1e5))), 90);
    EXPECT_LE(std::exp(a.curve.at(std::log(0.01))), 0.3);
    const double delta = 1 / a.curve.bins_per_ln, sigma = kCones.adapted_sigma(0.01);
    for (size_t i = 0; i + 1 < a.curve.node.size(); ++i) {
        const double scene = std::exp(p.ln_low + (double(i) + 0.5) * delta), shown = std::exp((a.curve.node[i] + a.curve.node[i + 1]) / 2);
        const double ceiling = cone_threshold(shown, ThresholdBreaks::continuous()) / shown / (kCones.threshold(scene, sigma) / scene);
        EXPECT_LE((a.curve.node[i + 1] - a.curve.node[i]) / delta, ceiling * 1.01 + 1e-6) << i;
    }
}

// The lamp comes in, vote by vote, and brightens, over bins: nothing jumps, and the ground keeps where it is placed.
TEST(AdjustReference, GapsOpenWithoutAJump) {
    for (double ground : {0.01, 1.0, 100.0}) {
        const shared::ToneParameters p = split_parameters(100);
        std::vector<double> before;
        double first = 0;
        const auto follow = [&](double lamp, double share) {
            const Adjusted a = curve_of_votes({{std::log(ground), 1 - share}, {std::log(lamp), share}}, ground, p);
            const double shown = a.curve.at(std::log(ground));
            if (before.empty()) first = shown;
            // The lamp's own votes take what 64 times their share of the range would be; the gap takes what is then left.
            EXPECT_NEAR(shown, first, 0.2) << ground << ": lamp of " << lamp << ", share " << share;
            for (size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(a.curve.node[i], before[i], 0.15) << ground << ": lamp of " << lamp << ", share " << share << ", node " << i;
            before = a.curve.node;
        };
        for (double share = 0; share < 3e-4; share += 4e-6) follow(30 * ground, share);
        for (double lamp = 30 * ground; lamp < 1e5; lamp *= 1.03) follow(lamp, 3e-4);
    }
}

// A street with spikes (sky, road, signs) and a tail of lamps. Fewer bins see the same through the same window.
TEST(AdjustReference, FewBinsGiveTheCurveOfMany) {
    std::vector<std::pair<double, double>> votes{{std::log(0.0202), 0.16}, {std::log(0.7), 0.05}, {std::log(95), 0.003}, {std::log(8000), 0.002}};
    std::mt19937 random(5);
    std::normal_distribution<double> road(std::log(1.6), 0.6), lamps(std::log(300), 2);
    for (int i = 0; i < 20000; ++i) votes.push_back({i % 20 == 0 ? lamps(random) : road(random), 0.785 / 20000});
    for (const uint32_t ceiling : {shared::kCeilingEye, shared::kCeilingHuman}) {
        const Curve finest = curve_of_votes(votes, 0.5, split_parameters(256, ceiling)).curve;
        for (const uint32_t bins : {90u, 100u, 128u, 160u, 200u}) {
            const Curve few = curve_of_votes(votes, 0.5, split_parameters(bins, ceiling)).curve;
            for (double ln = std::log(1e-3); ln < std::log(1e5); ln += 0.02) {
                const auto code = [&](const Curve& c) { return 255 * std::pow((std::exp(c.at(ln)) - 0.12) / (100 - 0.12), 1 / 2.2); };
                EXPECT_NEAR(code(few), code(finest), 1) << bins << " bins, " << std::exp(ln) << " cd/m^2";
            }
        }
    }
}
}  // namespace
}  // namespace vesper::reference
