// The anchored tone curve: closed forms, limits, and how far votes can move it. SPDX-License-Identifier: MIT
#include "passes/anchor_reference.h"

#include <gtest/gtest.h>

#include "support/histograms.h"

namespace vesper::reference::anchor_reference_test {
namespace {

/// A display of 300 cd/m^2 and hardly any black, so that closed forms need not know it; Weber's law holds at 0.3 of its
/// white.
shared::ToneParameters dark_display() {
    shared::ToneParameters p = split_parameters(100);
    p.display_low = 1e-5f, p.display_high = 300, p.viewer_sigma = float(kCones.adapted_sigma(90));
    return p;
}

/// The curve of an eye that is adapted to `adapted`, cd/m^2.
Adjusted curve_of_shares(const std::vector<double>& share, double adapted, const shared::ToneParameters& p) {
    return adjust(share, adapted,
                  thresholds_of(p, kCones, kCones.adapted_sigma(adapted), kRods, kRods.adapted_sigma(adapted)), p);
}

double code_of(double ln_shown, const shared::ToneParameters& p) {
    return 255 *
           std::pow(std::max((std::exp(ln_shown) - p.display_low) / (double(p.display_high) - p.display_low), 0.0),
                    1 / 2.2);
}

/// Some hills, narrow and broad, anywhere.
std::vector<double> random_votes(std::mt19937& random, size_t steps) {
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<double> share(steps, 0.0);
    const int hills = 1 + int(5 * uniform(random));
    for (int k = 0; k < hills; ++k) {
        const double at = double(steps) * uniform(random), spread = std::pow(100, uniform(random)) / 2,
                     height = std::pow(uniform(random), 3) / spread;
        for (size_t i = 0; i < steps; ++i) share[i] += height * std::exp(-std::pow((double(i) - at) / spread, 2) / 2);
    }
    const double sum = std::accumulate(share.begin(), share.end(), 0.0);
    for (double& x : share) x = sum > 0 ? x / sum : 1.0 / double(steps);
    return share;
}

// L / T(L) on the display, for a viewer adapted to 0.3 of its white, is that of the scene; in daylight, 0.3 of white. 2
// %: the node table is linear between steps, in which the curve bends.
TEST(AnchorReference, WhatTheEyeIsAdaptedToIsAsVisibleAsInTheScene) {
    const shared::ToneParameters p = dark_display();
    std::mt19937 random(3);
    for (double adaptation : {0.003, 0.03, 0.28, 3.0, 30.0, 300.0, 5000.0})
        for (int k = 0; k < 5; ++k) {
            const std::vector<double> share = random_votes(random, p.bins * p.steps_per_bin);
            const double shown = std::exp(curve_of_shares(share, adaptation, p).curve.at(std::log(adaptation)));
            const double threshold = kCones.threshold(shown, double(p.viewer_sigma));
            EXPECT_NEAR(shown / threshold / (adaptation / kCones.adapted_threshold(adaptation)), 1, 0.02) << adaptation;
            if (adaptation >= 300) {
                EXPECT_NEAR(shown / 90, 1, 0.02) << adaptation;
            }
        }
}

// Below the anchor the eye alone decides: with an adapted eye the response of the viewer is that of the eye.
TEST(AnchorReference, BelowTheAnchorResponsesAreThoseOfTheEye) {
    const shared::ToneParameters p = dark_display();
    std::mt19937 random(4);
    for (double adaptation : {0.05, 1.0, 100.0}) {
        const double sigma = kCones.adapted_sigma(adaptation);
        std::vector<double> before;
        for (int k = 0; k < 10; ++k) {
            const Curve curve = curve_of_shares(random_votes(random, p.bins * p.steps_per_bin), adaptation, p).curve;
            for (size_t i = 0; i < curve.node.size(); ++i) {
                const double luminance = std::exp(p.ln_low + double(i) / curve.bins_per_ln);
                if (luminance > adaptation || luminance < 0.03 * adaptation)
                    continue;  // steps are added up to 5e-4 of all
                const double shown = std::exp(curve.node[i]), viewer = double(p.viewer_sigma);
                EXPECT_NEAR(shown / (shown + viewer) / (luminance / (luminance + sigma)), 1, 0.02)
                    << adaptation << " " << luminance;
                if (!before.empty()) {
                    EXPECT_EQ(curve.node[i], before[i]) << "votes have moved what is below the anchor";
                }
            }
            before = curve.node;
        }
    }
}

// In the dark, and with all votes there: Ld = white L / (L + sigma white / sigma of the viewer), responses of the eye
// (Naka and Rushton 1966).
TEST(AnchorReference, WithoutVotesTheDisplayShowsTheResponseOfTheEye) {
    const shared::ToneParameters p = dark_display();
    const double dark = 2e-4, sigma = kCones.adapted_sigma(dark);
    const Curve curve = curve_of_votes({{std::log(dark), 1.0}}, dark, p).curve;
    for (double luminance : {0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5})
        EXPECT_NEAR(std::exp(curve.at(std::log(luminance))) /
                        (300 * luminance / (luminance + sigma * 300 / double(p.viewer_sigma))),
                    1, 0.01)
            << luminance;
}

// Ward's condition, the reason for it all: nothing becomes visible that was not. No step has more just noticeable
// differences than in the scene. 0.1 %: those of the scene are taken in the middle of the step here.
TEST(AnchorReference, NoStepIsSteeperThanItsCeiling) {
    std::mt19937 random(5);
    for (uint32_t ceiling : {shared::kCeilingEye, shared::kCeilingHuman, shared::kCeilingCones, shared::kCeilingLinear})
        for (double adaptation : {0.02, 0.6, 40.0, 3000.0}) {
            const shared::ToneParameters p = split_parameters(100, ceiling);
            const Viewer viewer(p);
            const Adjusted a = curve_of_shares(random_votes(random, p.bins * p.steps_per_bin), adaptation, p);
            const Thresholds t = thresholds_of(p, kCones, kCones.adapted_sigma(adaptation), kRods, 1);
            const double delta = 1 / a.curve.bins_per_ln;
            for (size_t i = 0; i + 1 < a.curve.node.size(); ++i) {
                const double scene = std::exp(p.ln_low + (double(i) + 0.5) * delta),
                             ceiling_there = delta * scene / t.scene(scene);
                const double risen =
                    viewer.differences(std::exp(a.curve.node[i + 1])) - viewer.differences(std::exp(a.curve.node[i]));
                EXPECT_GE(risen, -1e-9);
                // 0.5 %: thresholds have kinks, in Ward's merged ones where rods give way to cones, and the middle of a
                // step stands for all of it.
                EXPECT_LE(risen, ceiling_there * 1.005 + 1e-9)
                    << "ceiling " << ceiling << " at " << adaptation << " step " << i;
            }
            EXPECT_FALSE(a.under);
            EXPECT_NEAR(std::exp(a.curve.node.back()), double(p.display_high), 1e-3) << "the display is filled";
        }
}

// If a share s of the votes changes, no grey moves by more than 400 s codes: 1 % of the votes, 4 codes. Displays, eyes,
// votes and what changes are random.
TEST(AnchorReference, AShareOfTheVotesMovesNoGreyByMoreThanFourHundredTimesAsManyCodes) {
    const std::pair<float, float> displays[]{{0.116f, 100}, {0.5f, 200}, {20, 220}, {0.01f, 1000}, {0.01f, 10}};
    std::mt19937 random(6);
    std::uniform_real_distribution<double> uniform(0, 1);
    double worst = 0;
    for (uint32_t ceiling : {shared::kCeilingEye, shared::kCeilingHuman, shared::kCeilingCones, shared::kCeilingLinear})
        for (const auto& [low, high] : displays)
            for (int k = 0; k < 60; ++k) {
                shared::ToneParameters p = split_parameters(100, ceiling);
                p.display_low = low, p.display_high = high,
                p.viewer_sigma = float(kCones.adapted_sigma(0.3 * double(high)));
                const size_t steps = p.bins * p.steps_per_bin;
                const double adaptation = std::pow(10, -3 + 7 * uniform(random));
                const std::vector<double> share = random_votes(random, steps), others = random_votes(random, steps);
                const double s = std::pow(10, -4 + 3.5 * uniform(random));
                // Votes leave from a luminance upwards, or from everywhere; and go to one step, or to others' hills.
                std::vector<double> changed = share;
                double left = s;
                const size_t from = k % 2 == 0 ? 0 : size_t(uniform(random) * double(steps));
                for (size_t i = 0; i < steps && left > 0; ++i) {
                    double& bin = changed[(from + i) % steps];
                    const double gone = k % 2 == 0 ? s * share[i] : std::min(bin, left);
                    bin -= gone, left -= gone;
                }
                if (k % 4 < 2)
                    changed[size_t(uniform(random) * double(steps))] += s;
                else
                    for (size_t i = 0; i < steps; ++i) changed[i] += s * others[i];
                const Curve a = curve_of_shares(share, adaptation, p).curve,
                            b = curve_of_shares(changed, adaptation, p).curve;
                for (size_t i = 0; i <= steps; ++i) {
                    const double moved = std::abs(code_of(a.node[i], p) - code_of(b.node[i], p));
                    worst = std::max(worst, moved / s);
                    ASSERT_LE(moved, 400 * s + 1e-6) << "ceiling " << ceiling << " display " << low << " to " << high
                                                     << " adaptation " << adaptation << " share " << s << " node " << i;
                }
            }
    EXPECT_GE(worst, 100) << "nothing has been tried that matters";
}

// A lamp comes in, vote by vote, and brightens: nothing jumps, and what is darker than the eye's adaptation does not
// move at all.
TEST(AnchorReference, ALampComesInWithoutAJump) {
    for (double ground : {0.01, 1.0, 100.0}) {
        const shared::ToneParameters p = split_parameters(100);
        std::vector<double> before, first;
        const auto follow = [&](double lamp, double share) {
            const Adjusted a = curve_of_votes({{std::log(ground), 1 - share}, {std::log(lamp), share}}, ground, p);
            if (first.empty()) first = a.curve.node;
            for (size_t i = 0; i < before.size(); ++i)
                EXPECT_NEAR(code_of(a.curve.node[i], p), code_of(before[i], p), 0.05)
                    << ground << ": lamp of " << lamp << ", share " << share << ", node " << i;
            const size_t at = size_t((std::log(ground) - p.ln_low) * a.curve.bins_per_ln);
            for (size_t i = 0; i <= at; ++i) EXPECT_EQ(a.curve.node[i], first[i]);
            before = a.curve.node;
        };
        for (double share = 0; share < 3e-4; share += 4e-6) follow(30 * ground, share);
        for (double lamp = 30 * ground; lamp < 1e5; lamp *= 1.03) follow(lamp, 3e-4);
    }
}

// The eye adapts to 1 % more: a code at most, from the dark to daylight.
TEST(AnchorReference, NothingJumpsWithWhatTheEyeIsAdaptedTo) {
    std::mt19937 random(7);
    for (uint32_t ceiling :
         {shared::kCeilingEye, shared::kCeilingHuman, shared::kCeilingCones, shared::kCeilingLinear}) {
        const shared::ToneParameters p = split_parameters(100, ceiling);
        const std::vector<double> share = random_votes(random, p.bins * p.steps_per_bin);
        std::vector<double> before;
        for (double adapted = 1e-3; adapted < 1e4; adapted *= 1.01) {
            const std::vector<double> node = curve_of_shares(share, adapted, p).curve.node;
            for (size_t i = 0; i < before.size(); ++i)
                ASSERT_NEAR(code_of(node[i], p), code_of(before[i], p), 1)
                    << "ceiling " << ceiling << " at " << adapted << " node " << i;
            before = node;
        }
    }
}

// A few pixels of 1e5 cd/m^2 on 0.01 cd/m^2, nothing in between: the lamp is white, the ground stays dark.
TEST(AnchorReference, ALampShinesOnDarkGround) {
    const Adjusted a = curve_of_votes({{std::log(0.01), 0.9996}, {std::log(1e5), 4e-4}}, 0.01, split_parameters(100));
    EXPECT_GE(std::exp(a.curve.at(std::log(1e5))), 99);
    EXPECT_LE(std::exp(a.curve.at(std::log(0.01))), 0.3);
}

// An eye that is used to a dim road sees 1000 cd/m^2 near white; adapted to that, as 0.3 of white.
TEST(AnchorReference, ADazzledEyeSeesBrighter) {
    const shared::ToneParameters p = split_parameters(100);
    const std::vector<double> share = per_step(split_votes({{std::log(1000), 1.0}}, p), p);
    EXPECT_GE(std::exp(curve_of_shares(share, 0.3, p).curve.at(std::log(1000))), 75);
    EXPECT_NEAR(std::exp(curve_of_shares(share, 1000, p).curve.at(std::log(1000))), 30, 1);
    EXPECT_LE(std::exp(curve_of_shares(share, 5000, p).curve.at(std::log(10))), 0.6) << "from the day into a tunnel";
}

// An eye that sees better than the viewer of the display: what it sees does not reach down to black, and is not lifted
// from it.
TEST(AnchorReference, NoLightIsBlackForEveryEye) {
    const shared::ToneParameters p = split_parameters(100);
    std::mt19937 random(8);
    for (double factor : {0.3, 0.6, 0.9, 1.0, 2.0, 10.0})
        for (double adapted : {0.01, 1.0, 1000.0}) {
            vision::Receptors receptors = vision::Receptors::cones();
            receptors.threshold_factor = factor;
            const vision::ReceptorModel eye(vision::ReceptorKind::Cones, receptors);
            const Curve curve = adjust(random_votes(random, p.bins * p.steps_per_bin), adapted,
                                       thresholds_of(p, eye, eye.adapted_sigma(adapted), kRods, 1), p)
                                    .curve;
            EXPECT_LT(code_of(curve.node.front(), p), 2) << factor << " at " << adapted;
        }
}

// Half saturation says what the eye is adapted to, where it depends on that.
TEST(AnchorReference, AnAdaptedEyeIsAdaptedToWhatItLooksAt) {
    for (double luminance : {0.03, 0.3, 3.0, 60.0, 3000.0, 1e5})
        EXPECT_NEAR(adapted_luminance(kCones.adapted_sigma(luminance), kCones) / luminance, 1, 1e-6) << luminance;
    EXPECT_LT(adapted_luminance(kCones.dark_sigma(), kCones), 0.004) << "thresholds are the same from there down";
    EXPECT_NEAR(adapted_luminance(1e-6, kCones), 1e-4, 1e-12);
}

}  // namespace
}  // namespace vesper::reference::anchor_reference_test
