// Thresholds, water-filling and the tone curve, against published digits and properties. SPDX-License-Identifier: MIT
#include "passes/adapt_reference.h"
#include "passes/passes.h"

#include <random>

#include <gtest/gtest.h>

namespace vesper::reference {
namespace {

constexpr uint32_t kBins = 100;

/// Infinite lambda: Ward's own fixed point.
constexpr double kNoLimit = 1e30;

shared::ToneParameters parameters_of(double low = 0.5, double high = 200, uint32_t ceiling = shared::kCeilingCones) {
    shared::ToneParameters p{};
    p.ceiling = ceiling;
    p.cone_break = 1.9f, p.rod_break = -1.44f;
    p.adapt_to = shared::kAdaptAverage;
    p.bins = kBins, p.steps_per_bin = 1;
    p.ln_low = float(std::log(1e-4)), p.bins_per_ln = float(10 / std::log(10.0));  // tenths of a decade
    p.display_low = float(low), p.display_high = float(high);
    p.key = 0.18f;
    p.scotopic = 1;
    return p;
}

const ReceptorModel kCones(ReceptorKind::Cones, Receptors::cones()), kRods(ReceptorKind::Rods, Receptors::rods());

/// The curve for an eye adapted to `adaptation`.
Adjusted curve_of(const shared::Histogram& histogram, double adaptation, const shared::ToneParameters& p) {
    const Thresholds t = thresholds_of(p, kCones, kCones.adapted_sigma(adaptation), kRods, kRods.adapted_sigma(adaptation));
    return adjust(shares(histogram, kBins), adaptation, t, p);
}

/// Votes spread like a night street: a broad dark hill, a few bright lamps.
shared::Histogram night(uint32_t seed = 1) {
    shared::Histogram histogram{};
    std::mt19937 random(seed);
    std::normal_distribution<double> road(30, 8), lamps(85, 3);
    for (int i = 0; i < 20000; ++i) {
        const double at = i % 100 == 0 ? lamps(random) : road(random);
        ++histogram.count[uint32_t(std::clamp(at, 0.0, kBins - 1.0))];
        ++histogram.finite, ++histogram.votes;
    }
    return histogram;
}

/// All votes in a few neighbouring bins: fog, or an evenly lit day.
shared::Histogram fog(uint32_t from, uint32_t to) {
    shared::Histogram histogram{};
    for (uint32_t i = from; i <= to; ++i) histogram.count[i] = 100, histogram.finite += 100, histogram.votes += 100;
    return histogram;
}

// The toy of tone-mapping.md, 2.8.
TEST(AdaptReference, FillsTheRangeUnderTheCeilings) {
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
TEST(AdaptReference, TheCurveIsAFixedPointOfItsCeilings) {
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

TEST(AdaptReference, FillIsTheFixedPointOfWardsClipping) {
    const std::vector<double> h = with_spread(shares(night(), kBins));
    std::vector<double> c(kBins);
    for (uint32_t i = 0; i < kBins; ++i) c[i] = 0.35 + 0.3 * std::sin(i * 0.4);
    const double delta = std::log(10.0) / 10;
    const Slopes exact = fill(h, c, delta, 5, kNoLimit);
    ASSERT_FALSE(exact.under);
    const std::vector<double> clipped = ward(h, c, delta, 5, 20000);
    for (uint32_t i = 0; i < kBins; ++i) EXPECT_NEAR(clipped[i], exact.s[i], 1e-4) << i;
}

TEST(AdaptReference, ALittleIsSpreadOverAllBins) {
    std::vector<double> share(kBins, 0.0);
    EXPECT_EQ(with_spread(share), share) << "nobody has voted";
    share[10] = 0.75, share[14] = 0.25;
    const std::vector<double> h = with_spread(share);
    EXPECT_NEAR(std::accumulate(h.begin(), h.end(), 0.0), 1, 1e-14);
    EXPECT_NEAR(h[10], (0.75 + 1e-7) / 1.00001, 1e-15);
    EXPECT_NEAR(h[12], 1e-7 / 1.00001, 1e-15);
}

TEST(AdaptReference, CurveIsMonotoneAndFillsTheDisplay) {
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
TEST(AdaptReference, NoBinIsSteeperThanItsCeiling) {
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
TEST(AdaptReference, FogKeepsItsContrastAndSitsWhereItIsVisible) {
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

TEST(AdaptReference, FogIsMovedNoFartherThanTheDisplayAllows) {
    const shared::ToneParameters p = parameters_of(0.5, 50);
    for (uint32_t bin : {2u, 20u, 60u, 95u}) {
        const Adjusted a = curve_of(fog(bin, bin), std::pow(10, -3.95 + 0.1 * bin), p);
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

/// One frame whose foveal level is one texel of `luminance`.
AdaptInputs frame_of(const shared::Histogram& histogram, double luminance, float seconds = 0) {
    AdaptInputs in{.histogram = histogram, .top = {luminance, 6, std::log(luminance), luminance}, .fovea = {1, 1, {{luminance, 6, std::log(luminance), luminance}}},
                   .observer = {}};
    in.parameters = parameters_of(0.5, 200, shared::kCeilingEye);
    in.parameters.cone_break = float(ThresholdBreaks::continuous().cones), in.parameters.rod_break = float(ThresholdBreaks::continuous().rods);
    in.parameters.adapt_to = shared::kAdaptGaze;
    in.parameters.gaze = {0.5f, 0.5f};
    in.parameters.seconds = seconds, in.parameters.smoothing_seconds = 0.15f;
    return in;
}

// Reinhard et al. 2002 with the luminances of tone-mapping.md, section 5: 0.01 to 1000 cd/m^2 in decades.
TEST(AdaptReference, ReinhardParameters) {
    AdaptInputs in = frame_of(night(), 1, 0.25f);
    in.top = {185.185, 6, std::log(10) / 2, 1000};
    in.previous.adaptation = 7, in.previous.seconds = 1.5f, in.previous.cones.pigment = in.previous.rods.pigment = 1;
    const Adapted a = adapt(in);
    EXPECT_NEAR(a.tone.log_average, std::sqrt(10), 1e-6);
    EXPECT_EQ(a.tone.adaptation, 1);
    EXPECT_NEAR(a.tone.reinhard_scale, 0.18 / std::sqrt(10), 1e-8);
    EXPECT_NEAR(a.tone.reinhard_white, 1 / std::pow(1000 * 0.18 / std::sqrt(10), 2), 1e-10);
    EXPECT_NEAR(a.tone.linear_gain, 1e-3, 1e-9) << "linear_high 0: up to the maximum";
    EXPECT_EQ(a.eye.adaptation, a.tone.adaptation);
    EXPECT_FLOAT_EQ(a.eye.seconds, 1.75f);

    in.parameters.white = 50, in.parameters.linear_low = 1, in.parameters.linear_high = 5;
    const Adapted b = adapt(in);
    EXPECT_NEAR(b.tone.reinhard_white, 1 / std::pow(50 * 0.18 / std::sqrt(10), 2), 1e-7);
    EXPECT_FLOAT_EQ(b.tone.linear_gain, 0.25f);
}

// Reinhard 2003 on what his formulas say for percentiles known by construction: votes even between 10^-1.5 and 10^1.5 cd/m^2.
TEST(AdaptReference, ReinhardsAutomaticParameters) {
    shared::Histogram even{};
    for (uint32_t i = 25; i < 55; ++i) even.count[i] = 10, even.finite += 10, even.votes += 10;
    AdaptInputs in = frame_of(even, 1);
    in.model = shared::kModelFixed, in.parameters.automatic = 1;
    in.top.z = std::log(3);
    const double span = std::log2(10) * 0.98 * 3, average = std::log2(3);
    const Adapted a = adapt(in);
    EXPECT_NEAR(a.tone.reinhard_scale, 0.18 * std::pow(4, 2 * average / span) / 3, 1e-6);
    EXPECT_NEAR(1 / std::sqrt(a.tone.reinhard_white), 1.5 * std::exp2(span - 5), 1e-4);
}

// Ferwerda et al. 1996 by hand: 1 cd/m^2, display of 200: thresholds of 100, 1 (cones) and 1 (rods) cd/m^2 from the table.
TEST(AdaptReference, FerwerdasGains) {
    AdaptInputs in = frame_of(night(), 1);
    in.model = shared::kModelGains, in.parameters.ceiling = shared::kCeilingHuman, in.parameters.rod_tint = {1, 1, 1};
    in.parameters.cone_break = 1.9f, in.parameters.rod_break = -1.44f;
    const Adapted a = adapt(in);
    EXPECT_NEAR(a.tone.linear_gain, 5.55904 / 0.391302 / 199.5, 1e-6);
    EXPECT_NEAR(a.tone.linear_low, 0.5 * 0.391302 / 5.55904, 1e-6);
    EXPECT_NEAR(a.tone.rods.x, std::pow(1 - 0.49 / 9.99, 2) * 0.391302 / 0.402717, 5e-6) << "six digits";
    in.parameters.ceiling = shared::kCeilingEye;
    EXPECT_NEAR(adapt(in).tone.linear_gain, a.tone.linear_gain, 1e-6) << "adapted, an eye in its state is the same";
}

// A street all in the light of sodium lamps: once adapted, its white is nearer to white by the degree of CIECAM02 at 1 cd/m^2, 0.8259; after a
// change half of the way is gone at once, and half of the rest after 20 s (Rinner and Gegenfurtner 2000).
TEST(AdaptReference, TheEyeAdaptsToColours) {
    AdaptInputs in = frame_of(night(), 1);
    in.model = shared::kModelGains, in.parameters.ceiling = shared::kCeilingEye, in.parameters.rod_tint = {1, 1, 1};
    const dvec3 sodium = dvec3(2, 0.7, 0.1) / luminance({2, 0.7, 0.1});
    const auto seen = [&](const Adapted& a, dvec3 rgb) { return dvec3(glm::dot(dvec3(a.tone.red), rgb), glm::dot(dvec3(a.tone.green), rgb), glm::dot(dvec3(a.tone.blue), rgb)); };
    in.colours = {2, 1, {dvec4(0.5 * sodium, 800), dvec4(2.0 * sodium, 800)}};
    const Adapted adapted = adapt(in);
    const double degree = 1 - std::exp(-43.0 / 92) / 3.6;
    EXPECT_NEAR(degree, 0.8259, 1e-4);
    EXPECT_NEAR(glm::length(cone_responses(seen(adapted, sodium)) - (degree * cone_responses(dvec3(1)) + (1 - degree) * cone_responses(sodium))), 0, 1e-5);
    in.colours = {1, 1, {dvec4(3, 3, 3, 100)}};
    EXPECT_NEAR(glm::length(seen(adapt(in), {1, 2, 3}) - dvec3(1, 2, 3)), 0, 1e-6) << "white changes nothing";

    in.previous = adapted.eye, in.parameters.seconds = 20;  // from sodium into white light
    const Adapted later = adapt(in);
    const dvec3 before(adapted.eye.chroma), after(later.eye.chroma);
    EXPECT_NEAR(glm::length(after - 0.5 * before), 0, 1e-6);
    const glm::dmat3 wanted = chromatic_adaptation(0.25 * before, 1);
    EXPECT_NEAR(glm::length(seen(later, {1, 2, 3}) - wanted * dvec3(1, 2, 3)), 0, 1e-5);
    in.parameters.seconds = 0;
    EXPECT_NEAR(glm::length(dvec3(adapt(in).eye.chroma) - before), 0, 1e-7) << "a pause";
}

TEST(AdaptReference, AnEmptyFrameIsBlack) {
    AdaptInputs in = frame_of({}, 1);
    in.top = dvec4(0), in.fovea.texels = {dvec4(0)};
    const Adapted a = adapt(in);
    for (uint32_t i = 0; i <= kBins; ++i) EXPECT_NEAR(a.tone.node[i].x, std::log(0.5), 1e-7);
    EXPECT_FLOAT_EQ(a.tone.log_average, 1e-4f);
    EXPECT_TRUE(std::isfinite(a.tone.reinhard_white));
    EXPECT_TRUE(std::isfinite(a.tone.linear_gain));
}

// What is empty between two frames changes nothing but the time.
TEST(AdaptReference, AnEmptyFrameLeavesWhatWas) {
    AdaptInputs in = frame_of(night(), 3);
    const Adapted before = adapt(in);
    in.previous = before.eye, in.parameters.seconds = 5;
    in.histogram = {}, in.top = dvec4(0), in.fovea.texels = {dvec4(0)};
    const Adapted after = adapt(in);
    EXPECT_EQ(after.eye.adaptation, 3);
    EXPECT_FLOAT_EQ(after.tone.cone_sigma, before.tone.cone_sigma);
    for (uint32_t i = 0; i <= kBins; ++i) EXPECT_NEAR(after.tone.node[i].x, before.tone.node[i].x, 1e-5);
}

TEST(AdaptReference, TheGazeIsMetBetweenTexels) {
    AdaptInputs in = frame_of({}, 1);
    in.fovea = {5, 4, {}};
    in.parameters.adapt_to = shared::kAdaptGazeMean;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x) in.fovea.texels.emplace_back(10 + x + 3 * y, 4, 0.1 * x - 0.2 * y, 0);
    const auto at = [&](float x, float y) {
        in.parameters.gaze = {x, y};
        return gaze_luminance(in.fovea, in.parameters);
    };
    // A plane: its value at the gaze wherever 4 x 4 texels are there.
    for (float x : {2.0f, 2.5f, 2.75f})
        for (float y : {1.6f, 2.0f, 2.3f}) EXPECT_NEAR(at(x, y), 10 + (x - 0.5) + 3 * (y - 0.5), 1e-6) << x << " " << y;
    EXPECT_NEAR(at(0.5f, 0.5f), 12, 1e-12) << "in the corner, of four texels";
    in.parameters.adapt_to = shared::kAdaptGaze;
    EXPECT_NEAR(std::log(at(2.25f, 2.0f)), 0.1 * 1.75 - 0.2 * 1.5, 1e-6) << "a plane of logarithms";
    in.parameters.adapt_to = shared::kAdaptGazeMean;
    in.fovea.texels[6].y = 0;
    EXPECT_NEAR(at(1.5f, 1.5f), (9 * 14.0 - in.fovea.texels[6].x) / 8, 1e-6) << "pixels that are not finite do not count";
    in.parameters.adapt_to = shared::kAdaptTexel;
    EXPECT_EQ(at(3.9f, 2.1f), 19);
    EXPECT_EQ(at(99, -5), 14);
}

// What trimming stops at is the solved curve within its tolerance of 2.5 % of the total: 0.025 in log10 here.
TEST(AdaptReference, TrimmedCurvesAreNearTheSolvedOnes) {
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
TEST(AdaptReference, TrimmingHasItsEndsRight) {
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

// tone-mapping.md, 2.6: 5000 to 50 cd/m^2, through the state as the device keeps it. Two percent are asked for.
TEST(AdaptReference, AdaptsToATunnelOverTime) {
    const double table[][2]{{0.05, 4204}, {0.2, 1772}, {1, 1317}, {5, 737.8}, {10, 459.0}, {20, 281.1}, {60, 184.3}, {300, 135.9}};
    AdaptInputs in = frame_of(night(), 5000);
    in.previous = adapt(in).eye;
    double now = 0;
    for (const auto& [seconds, sigma] : table) {
        AdaptInputs next = frame_of(night(), 50, float(seconds - now));
        next.previous = in.previous;
        const Adapted a = adapt(next);
        in.previous = a.eye, now = seconds;
        EXPECT_NEAR(a.tone.cone_sigma / sigma, 1, 2e-3) << seconds;
    }
}

// 60 steps of 1/60 s are 30 of 1/30 s: within 0.5 % is asked for. A pause freezes everything.
TEST(AdaptReference, TimeIsWhatCountsAndNotFrames) {
    const auto run = [](int steps, float seconds) {
        AdaptInputs in = frame_of(night(1), 5000);
        in.previous = adapt(in).eye;
        for (int i = 0; i < steps; ++i) {
            AdaptInputs next = frame_of(night(2), 50, seconds);
            next.previous = in.previous;
            in.previous = adapt(next).eye;
        }
        return in.previous;
    };
    const shared::EyeState many = run(60, 1.0f / 60), few = run(30, 1.0f / 30), once = run(1, 1);
    for (const shared::EyeState& other : {few, once}) {
        EXPECT_NEAR(many.cones.fast, other.cones.fast, 1e-5);
        EXPECT_NEAR(many.cones.slow, other.cones.slow, 1e-5);
        EXPECT_NEAR(many.cones.pigment, other.cones.pigment, 1e-5);
    }
    for (uint32_t i = 0; i <= kBins; ++i) EXPECT_NEAR(many.node[i], few.node[i], 5e-3) << i;
    AdaptInputs pause = frame_of(night(3), 1000, 0);
    pause.previous = many;
    const shared::EyeState paused = adapt(pause).eye;
    EXPECT_EQ(paused.cones.fast, many.cones.fast);
    EXPECT_EQ(paused.cones.pigment, many.cones.pigment);
    for (uint32_t i = 0; i <= kBins; ++i) EXPECT_EQ(paused.node[i], many.node[i]);
}

// More and more of the picture goes dark while the rest stays: what is bright is shown brighter and brighter, and never pops:
// 5 % fewer bright pixels are at most 8 % more light. (Below a tenth of the picture, where lambda may be at its limit, what is
// left of their share of the range goes, by at most 1 % of light a step.)
TEST(AdaptReference, DarkPixelsMakeTheRestBrighterAndNeverPop) {
    for (uint32_t ceiling : {shared::kCeilingEye, shared::kCeilingCones, shared::kCeilingHuman})
        for (double adaptation : {0.1, 3.0, 30.0}) {
            const auto p = parameters_of(0.5, 200, ceiling);
            const Thresholds t = thresholds_of(p, kCones, kCones.adapted_sigma(adaptation), kRods, kRods.adapted_sigma(adaptation));
            double before = -1e9;
            for (double bright = 1; bright > 0.03; bright *= 0.95) {
                std::vector<double> share(kBins, 0.0);
                for (uint32_t i = 50; i <= 60; ++i) share[i] = bright / 11;
                share[25] = 1 - bright;
                const double shown = adjust(share, adaptation, t, p).curve.at(std::log(20));
                if (bright < 1) {
                    EXPECT_GE(shown, before - (bright > 0.1 ? 1e-6 : 0.012)) << bright << " ceiling " << ceiling << " at " << adaptation;
                    EXPECT_LE(shown, before + 0.08) << bright << " ceiling " << ceiling << " at " << adaptation;
                }
                before = shown;
            }
        }
}

// A hill of the histogram moves over the edges of bins in small steps: the curve moves with it, without a jump. Votes
// that are shared by two bins make that so.
TEST(AdaptReference, NothingJumpsAcrossTheEdgeOfABin) {
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

/// Votes of luminances (ln) and their shares, each shared by two bins.
std::vector<double> split_votes(const std::vector<std::pair<double, double>>& votes, const shared::ToneParameters& p) {
    std::vector<double> share(p.bins, 0.0);
    for (const auto& [ln, part] : votes) {
        const double middle = std::clamp((ln - p.ln_low) * double(p.bins_per_ln) - 0.5, 0.0, p.bins - 1.0);
        const size_t bin = std::min(size_t(middle), size_t(p.bins - 2));
        share[bin] += part * (1 - (middle - double(bin))), share[bin + 1] += part * (middle - double(bin));
    }
    return share;
}

/// The default settings' parameters at a number of bins; a display from 0.12 to 100 cd/m^2.
shared::ToneParameters split_parameters(uint32_t bins, uint32_t ceiling = shared::kCeilingEye) {
    shared::ToneParameters p = parameters_of(0.12, 100, ceiling);
    const HistogramSettings settings{.bins = bins};
    p.bins = bins, p.bins_per_ln = settings.bins_per_ln(), p.steps_per_bin = settings.steps_per_bin(), p.window = settings.window();
    p.cone_break = float(ThresholdBreaks::continuous().cones), p.rod_break = float(ThresholdBreaks::continuous().rods);
    return p;
}

Adjusted curve_of_votes(const std::vector<std::pair<double, double>>& votes, double adaptation, const shared::ToneParameters& p) {
    const Thresholds t = thresholds_of(p, kCones, kCones.adapted_sigma(adaptation), kRods, kRods.adapted_sigma(adaptation));
    return adjust(per_step(split_votes(votes, p), p), adaptation, t, p);
}

// A few pixels of 1e5 cd/m^2 on 0.01 cd/m^2, nothing in between. The eye's ceilings allow 80 just noticeable differences, more
// than the display has: the lamp is white, the ground stays dark, and what lies between is in between, under its ceilings.
TEST(AdaptReference, ALampShinesOnDarkGround) {
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
TEST(AdaptReference, GapsOpenWithoutAJump) {
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

// A uniform field that steps from one luminance to another: what is shown is the eye's recovery, and nothing comes back of what was before.
TEST(AdaptReference, RecoversMonotonicallyFromAStep) {
    const double fields[][2]{{50, 5000}, {5000, 50}, {1, 5000}, {5000, 1}, {100, 0.1}};
    for (const auto& [from, to] : fields)
        for (double step : {1 / 60.0, 0.1}) {
            const auto field = [&](double luminance, double seconds) {
                AdaptInputs in = frame_of({}, luminance, float(seconds));
                const shared::ToneParameters p = split_parameters(100);
                in.parameters.bins_per_ln = p.bins_per_ln, in.parameters.steps_per_bin = p.steps_per_bin, in.parameters.window = p.window;
                in.parameters.display_low = p.display_low, in.parameters.display_high = p.display_high;
                const auto share = split_votes({{std::log(luminance), 1.0}}, p);
                in.histogram.finite = 6;
                for (uint32_t i = 0; i < kBins; ++i) in.histogram.count[i] = uint32_t(1e6 * share[i] + 0.5), in.histogram.votes += in.histogram.count[i];
                return in;
            };
            shared::EyeState eye = adapt(field(from, 0)).eye;
            double before = 0;
            for (double now = step; now < 3; now += step) {
                AdaptInputs next = field(to, step);
                next.previous = eye;
                const Adapted a = adapt(next);
                const double shown = std::exp(a.adjusted.curve.at(std::log(to)));
                // 0.1 s: what is left of the curve before, a tenth at most, is gone.
                EXPECT_GE(shown, before * (now < 0.1 ? 0.95 : 0.999)) << from << " to " << to << " cd/m^2 in steps of " << step << " s, after " << now << " s";
                if (now > 0.5) {
                    EXPECT_LE(shown, before * (1 + 1.5 * step)) << "faster than the eye, " << from << " to " << to << " cd/m^2 in steps of " << step << " s, after " << now << " s";
                }
                before = shown, eye = a.eye;
            }
        }
}

// A street with spikes (sky, road, signs) and a tail of lamps. Fewer bins see the same through the same window.
TEST(AdaptReference, FewBinsGiveTheCurveOfMany) {
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

// Twice the pixels in every bin is the same picture.
TEST(AdaptReference, OnlyTheShapeOfTheHistogramMatters) {
    shared::Histogram once = night(), twice = once;
    twice.finite *= 2, twice.votes *= 2;
    for (uint32_t& n : twice.count) n *= 2;
    const Adjusted a = curve_of(once, 1, parameters_of()), b = curve_of(twice, 1, parameters_of());
    for (size_t i = 0; i <= kBins; ++i) EXPECT_DOUBLE_EQ(a.curve.node[i], b.curve.node[i]);
}

}  // namespace
}  // namespace vesper::reference
