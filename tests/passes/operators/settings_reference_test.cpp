// What operators are told, in numbers of their publications. References read what the engine tells them; here it is
// compared with literals. SPDX-License-Identifier: MIT
#include <cmath>

#include <gtest/gtest.h>

#include "render/passes/adapt.h"
#include "render/passes/operators.h"
#include "vision/display.h"

namespace vesper::test::operator_settings_test {
namespace {

using render::Operator, render::OperatorSettings;

void expect_block(Operator op, const OperatorSettings& settings, glm::vec4 want) {
    const render::OperatorBlock block = settings.block(op, vision::Display{});
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(block[0][c], want[c], 1e-6f * std::abs(want[c])) << c;
    EXPECT_EQ(block[1], glm::vec4(0));
}

// Reinhard et al. 2002: a key of 0.18 is usual; the white is the largest luminance.
TEST(OperatorSettings, OfReinhardAreKeyAndWhite) {
    expect_block(Operator::Reinhard, {}, {0.18f, 0, 0, 0});
    OperatorSettings settings;
    settings.reinhard.key = 0.36f, settings.reinhard.white = 50, settings.reinhard.automatic = true;
    expect_block(Operator::Reinhard, settings, {0.36f, 50, 1, 0});
}

// Drago et al. 2003, Eq. 3 and 4: the exponent ln(b) / ln(1/2); 0.85 is their best bias, of the exponent 0.2345.
TEST(OperatorSettings, OfDragoAreTheExponentOfTheBias) {
    expect_block(Operator::Drago, {}, {0.23446525f, 0, 0, 0});
    OperatorSettings settings;
    settings.drago.bias = 0.5f;
    expect_block(Operator::Drago, settings, {1, 0, 0, 0});
}

// Reinhard and Devlin 2005: f = exp(-f'), and m, a and c as they are; a of 0.75 and c of 0.5 are those of pfstools.
TEST(OperatorSettings, OfDevlinAreTheFourParameters) {
    expect_block(Operator::Devlin, {}, {1, 0, 0.75f, 0.5f});
    OperatorSettings settings;
    settings.devlin.intensity = 1, settings.devlin.contrast = 0.4f;
    settings.devlin.light_adaptation = 0.2f, settings.devlin.chromatic_adaptation = 0.9f;
    expect_block(Operator::Devlin, settings, {0.36787944f, 0.4f, 0.2f, 0.9f});
}

// Pattanaik et al. 2000, Eq. 9: j = 1 / (5 x 10^5 A + 1).
TEST(OperatorSettings, OfPattanaikAreTheConstantOfTheRods) {
    expect_block(Operator::Pattanaik, {}, {500'000, 0, 0, 0});
    OperatorSettings settings;
    settings.pattanaik.rod_constant = 5e4f;
    expect_block(Operator::Pattanaik, settings, {50'000, 0, 0, 0});
}

// Ferwerda et al. 1996: rods add the same to all channels; Durand and Dorsey 2000: blue of (1.05, 0.97, 1.27).
TEST(OperatorSettings, OfGainsAreTheColourOfTheRods) {
    expect_block(Operator::Ferwerda, {}, {1, 1, 1, 0});
    expect_block(Operator::Durand, {}, {1.05f, 0.97f, 1.27f, 0});
}

TEST(OperatorSettings, OfScalesAreTheirLuminances) {
    OperatorSettings settings;
    settings.linear.low = 2, settings.linear.high = 80, settings.neutral.white = 300;
    expect_block(Operator::Linear, settings, {2, 80, 0, 0});
    expect_block(Operator::Neutral, settings, {300, 0, 0, 0});
    expect_block(Operator::Linear, {}, {0, 0, 0, 0});
    expect_block(Operator::Neutral, {}, {0, 0, 0, 0});
}

TEST(OperatorSettings, OfOtherOperatorsAreNone) {
    for (const Operator op : {Operator::Irawan, Operator::Ward, Operator::Grave, Operator::Ldr})
        expect_block(op, {}, glm::vec4(0));
}

shared::ToneParameters parameters_of(Operator op, const render::ToneSettings& tone = {}) {
    return render::tone_parameters(render::operator_info(op), {}, tone, vision::Display{}, {3, {40, 30}, {320, 240}},
                                   0.25f);
}

// Ferwerda et al. 1996, Eq. 1 and 2: thresholds of cones follow Weber's law from log L = 1.9 on, those of rods from
// -1.44 on, which leave gaps in the curves; an eye that adapts over time has them where the pieces meet.
TEST(OperatorParameters, HaveThePublishedBreaksOfThresholds) {
    for (const Operator op : {Operator::Ward, Operator::Ferwerda}) {
        EXPECT_FLOAT_EQ(parameters_of(op).cone_break, 1.9f);
        EXPECT_FLOAT_EQ(parameters_of(op).rod_break, -1.44f);
        EXPECT_EQ(parameters_of(op).ceiling, 1u) << "cones and rods";
    }
    // Cones: (0.249 l + 0.65)^2.7 - 0.72 = l - 1.255; rods: (0.405 l + 1.6)^2.18 - 2.86 = l - 0.395.
    const shared::ToneParameters p = parameters_of(Operator::Irawan);
    EXPECT_EQ(p.ceiling, 0u);
    EXPECT_NEAR(std::pow(0.249 * p.cone_break + 0.65, 2.7) - 0.72, p.cone_break - 1.255, 1e-3);
    EXPECT_NEAR(std::pow(0.405 * p.rod_break + 1.6, 2.18) - 2.86, p.rod_break - 0.395, 1e-3);
}

TEST(OperatorParameters, ArePlacesAndTimesOfTheFrame) {
    render::ToneSettings tone;
    tone.gaze = {0.25f, 0.5f};
    const shared::ToneParameters p = parameters_of(Operator::Irawan, tone);
    EXPECT_EQ(p.gaze, glm::vec2(10, 15)) << "80 and 120 px, of 8 px a texel";
    EXPECT_EQ(p.foveal_size, glm::uvec2(40, 30));
    EXPECT_EQ(p.seconds, 0.25f);
    EXPECT_EQ(p.adapt_to, 0u) << "the gaze";
    EXPECT_EQ(parameters_of(Operator::Ward).adapt_to, 3u) << "the log average";
}

// White of Rec. 709 by Larson et al. 1997: V = Y (1.33 (1 + (Y + Z) / X) - 1.68).
TEST(OperatorParameters, RodsSeeTheScotopicLightOfWhite) {
    const double x = 0.95047, y = 1, z = 1.08883;
    EXPECT_NEAR(parameters_of(Operator::Irawan).scotopic, 1.33 * (1 + (y + z) / x) - 1.68, 1e-3);
    render::ToneSettings tone;
    tone.photopic_rods = true;
    EXPECT_EQ(parameters_of(Operator::Irawan, tone).scotopic, 1);
}

}  // namespace
}  // namespace vesper::test::operator_settings_test
