// Bands of contrast: what can be said of them by hand. SPDX-License-Identifier: MIT
#include "passes/bands_reference.h"
#include "vision/eye.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace vesper::reference::bands_reference_test {
namespace {

constexpr vision::ThresholdBreaks kBreaks = vision::ThresholdBreaks::continuous();
const vision::ReceptorModel kViewer(vision::ReceptorKind::Cones, vision::Receptors::cones());
constexpr double kViewerSees = 60;  // cd/m^2

shared::ToneParameters display_parameters() {
    shared::ToneParameters p{};
    p.cone_break = float(kBreaks.cones), p.rod_break = float(kBreaks.rods);
    p.viewer_sigma = float(kViewer.adapted_sigma(kViewerSees)), p.viewer_step = float(kViewer.response_step());
    return p;
}

/// ln Ld = ln of `factor` + power ln L, from 1e-4 to 1e8 cd/m^2.
shared::ToneCurve power_curve(double factor, double power) {
    shared::ToneCurve c{};
    c.bins = 256, c.ln_low = float(std::log(1e-4)), c.bins_per_ln = float(256 / std::log(1e12));
    for (int i = 0; i <= 256; ++i)
        c.node[i].x = float(std::log(factor) + power * (std::log(1e-4) + i / 256.0 * std::log(1e12)));
    return c;
}

std::vector<double> shown(const std::vector<double>& l, uint32_t width, uint32_t height, uint32_t top,
                          const shared::ToneCurve& curve) {
    std::vector<dvec3> rgb;
    for (const double y : l) rgb.emplace_back(y);
    std::vector<double> made =
        bands(l, width, height, pyramid(std::span<const dvec3>(rgb), width, height), top, curve, display_parameters())
            .shown;
    for (double& m : made) m = std::exp(m);
    return made;
}

TEST(BandsReference, WhatIsEvenFollowsTheCurve) {
    for (const double l : {1e-3, 0.5, 40.0, 3e4})
        for (const uint32_t top : {1u, 3u, 5u})
            for (const double s : shown(std::vector<double>(40 * 30, l), 40, 30, top, power_curve(3, 0.6)))
                ASSERT_NEAR(s / (3 * std::pow(l, 0.6)), 1, 1e-6) << l;
}

// A display too dark for the visibility of the scene: ratios are kept, whatever the picture.
TEST(BandsReference, NoContrastIsMoreThanInTheScene) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> decades(2.1, 5);
    std::vector<double> l;
    for (int i = 0; i < 37 * 23; ++i) l.push_back(std::pow(10, decades(random)));
    const std::vector<double> s = shown(l, 37, 23, 5, power_curve(5e-4, 1));
    for (size_t i = 0; i < l.size(); ++i) EXPECT_NEAR(s[i] / (5e-4 * l[i]), 1, 1e-5);  // nodes are floats
}

// A target smaller than the finest band: its difference is as many thresholds on the display as in the scene, as far as
// a contrast of 0.01 is its logarithm; or as many as the same contrast has. What of it is left in the mean of the
// topmost texels, 1 / 4^top, is mapped by the curve instead.
TEST(BandsReference, SmallTargetsKeepTheirVisibilityLevel) {
    for (const double background : {0.02, 0.5, 5.0, 300.0})
        for (const double contrast : {-0.01, 0.01}) {
            std::vector<double> l(64 * 64, background);
            l[64 * 31 + 33] *= 1 + contrast;
            const double field = std::exp(node_at(background, power_curve(6, 0.5)).x);
            const double difference = shown(l, 64, 64, 5, power_curve(6, 0.5))[64 * 31 + 33] - field;
            const double in_scene = contrast * background / vision::cone_threshold(background, kBreaks),
                         on_display = difference / kViewer.threshold(field, kViewer.adapted_sigma(kViewerSees));
            const double same_contrast =
                contrast * field / kViewer.threshold(field, kViewer.adapted_sigma(kViewerSees));
            EXPECT_NEAR(on_display / std::copysign(std::min(std::abs(in_scene), std::abs(same_contrast)), contrast), 1,
                        0.02)
                << background;
        }
}

// Two fields far larger than the topmost texels: each is shown as the curve has it, away from the edge.
TEST(BandsReference, LargeFieldsFollowTheCurve) {
    std::vector<double> l;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 64; ++x) l.push_back(x < 32 ? 0.1 : 100);
    const auto curve = power_curve(6, 0.5);
    const std::vector<double> s = shown(l, 64, 16, 2, curve);
    for (int y = 0; y < 16; ++y) {
        EXPECT_NEAR(s[64 * y + 10], 6 * std::sqrt(0.1), 1e-4);
        EXPECT_NEAR(s[64 * y + 50], 6 * std::sqrt(100), 1e-2);
    }
}

// A lamp that covers a thousandth of a degree hardly moves the log average there, and so neither the ground beside it:
// no halo.
TEST(BandsReference, ALampLeavesTheGroundBesideIt) {
    std::vector<double> l(64 * 64, 1.0);
    l[64 * 31 + 33] = 1e5;
    const std::vector<double> s = shown(l, 64, 64, 5, power_curve(6, 0.5));
    EXPECT_NEAR(s[64 * 10 + 8] / 6, 1, 0.03);
    EXPECT_GT(s[64 * 31 + 33], 1000);
}

// A dark post in daylight: contrasts in the dark are steeper, and what is bright beside them takes little part in that.
TEST(BandsReference, DarkThingsHaveNoGlowAroundThem) {
    std::vector<double> l;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) l.push_back(x >= 28 && x < 35 && y >= 20 ? 3 : 2000);
    const auto curve = power_curve(1, 0.6);
    const std::vector<double> s = shown(l, 64, 64, 5, curve);
    const double field = std::exp(node_at(2000, curve).x), brightest = *std::max_element(s.begin(), s.end());
    EXPECT_LT(brightest / field, 3);  // 2.6; 9 where steepness itself, and not its logarithm, is mixed
}

TEST(BandsReference, NoLightIsGrey) {
    EXPECT_EQ(banded({0, 0, 0}, 3, shared::kToneCurve, {}), dvec3(3));
    EXPECT_NEAR(glm::length(banded({1, 2, 4}, luminance({2, 4, 8}), shared::kToneCurve, {}) - dvec3(2, 4, 8)), 0,
                1e-12);
}

}  // namespace
}  // namespace vesper::reference::bands_reference_test
