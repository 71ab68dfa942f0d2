// Khronos PBR Neutral 2024 (github.com/KhronosGroup/ToneMapping): in double, and on the device.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/operator_chain.h"

namespace vesper::reference::neutral_test {
namespace {

/// Light of a colour, both 1 for white.
dvec3 neutral(dvec3 colour) {
    const double start = 0.8 - 0.04, least = std::min({colour.x, colour.y, colour.z});
    const dvec3 base = colour - dvec3(least < 0.08 ? least - least * least / (4 * 0.04) : 0.04);
    const double peak = std::max({base.x, base.y, base.z});
    if (peak < start) return base;
    const double shown = 1 - std::pow(1 - start, 2) / (peak + 1 - 2 * start);
    const double kept = 1 / (0.15 * (peak - shown) + 1);
    return kept * base * (shown / peak) + (1 - kept) * dvec3(shown);
}

void neutral_frame(const OperatorFrame& f, Adapted& out) {
    const float white = f.in.parameters.settings[0].x;
    const double scale = white > 0 ? 1 / double(white) : 0.18 / f.log_average;
    out.tone.block[0].x = float(scale);
    write_table(f.in.parameters, out.tone, [&](double l) { return neutral(dvec3(scale * l)).x; });
}

dvec3 neutral_rgb(const shared::ToneCurve& curve, dvec3 rgb) {
    return neutral(glm::max(double(curve.block[0].x) * rgb, dvec3(0)));
}

const KnownReference kKnown(render::Operator::Neutral, {.frame = neutral_frame, .rgb = neutral_rgb});

// By its specification: greys and colours between 0.08 and 0.8 lose 0.04 and nothing else; 0.04, the reflection of a
// black dielectric, becomes 0.01.
TEST(Neutral, KeepsBaseColours) {
    for (const double grey : {0.08, 0.18, 0.5, 0.79}) EXPECT_NEAR(neutral(dvec3(grey)).x, grey - 0.04, 1e-12);
    EXPECT_NEAR(glm::length(neutral({0.7, 0.3, 0.1}) - dvec3(0.66, 0.26, 0.06)), 0, 1e-12);
    EXPECT_NEAR(neutral(dvec3(0.04)).x, 0.01, 1e-12);
    EXPECT_EQ(neutral(dvec3(0)), dvec3(0));
}

// Without a kink where compression begins, 1 for endless light, and white for endless light of any colour.
TEST(Neutral, CompressesTowardsWhite) {
    EXPECT_NEAR((neutral(dvec3(0.8001)).x - neutral(dvec3(0.8)).x) / 1e-4, 1, 1e-3);
    EXPECT_NEAR(neutral(dvec3(0.8)).x, 0.76, 1e-12);
    EXPECT_NEAR(neutral(dvec3(1)).x, 1 - 0.24 * 0.24 / 0.44, 1e-12);
    EXPECT_NEAR(neutral(dvec3(1e9)).x, 1, 1e-9);
    EXPECT_NEAR(glm::length(neutral({1e9, 1e3, 0}) - dvec3(1)), 0, 1e-6);
    for (double l = 0.01, last = 0; l < 1e4; l *= 1.2) {
        EXPECT_GT(neutral(dvec3(l)).x, last) << l;
        last = neutral(dvec3(l)).x;
    }
}

}  // namespace
}  // namespace vesper::reference::neutral_test

namespace vesper::test::neutral_test {
namespace {

TEST(Neutral, TheDeviceEqualsTheReference) {
    render::OperatorSettings settings;
    expect_reference(render::Operator::Neutral, settings);
    settings.neutral.white = 50;
    expect_reference(render::Operator::Neutral, settings);
}

}  // namespace
}  // namespace vesper::test::neutral_test
