// Display codes on the device against their reference. SPDX-License-Identifier: MIT
#include "passes/composite_reference.h"

#include "support/compare.h"
#include "support/texels.h"
#include "support/tones.h"

namespace vesper::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

// Codes beyond the half that rounding takes. log, exp and pow in float, the curve's slope and the 8-bit store each move
// a code by some thousandths.
constexpr double kBeyond = 0.02;

struct Inputs {
    VkExtent2D extent;
    std::vector<glm::vec4> scene, veil, glare;  ///< veil, glare: empty for none
    shared::ToneCurve curve;
    Display display;
    float gain = 1;
};

VkExtent2D quarter(VkExtent2D e) { return {(e.width + 3) / 4, (e.height + 3) / 4}; }

std::vector<uint8_t> composite(PassRig& rig, const Inputs& in, uint32_t tone) {
    FrameGraph graph;
    View view;
    view.extent = in.extent;
    CompositeInputs inputs{rig.image(graph, "scene", kSceneFormat, in.extent, in.scene),
                           graph.upload("curve", std::vector{in.curve}, VK_FORMAT_R32G32B32A32_SFLOAT),
                           {},
                           {}};
    if (!in.veil.empty()) inputs.luminance_glare = rig.image(graph, "veil", kSceneFormat, in.extent, in.veil);
    if (!in.glare.empty())
        inputs.ldr_glare = rig.image(graph, "glare", kGlareFormat, quarter(in.extent), to_halves(in.glare));
    const Resource kept =
        keep<glm::u8vec4>(graph, add_composite(graph, rig.kernels(), inputs, tone, view, in.display, in.gain));
    rig.run(graph);
    return rig.got<uint8_t>(kept);
}

void expect_reference(const std::vector<uint8_t>& got, const Inputs& in, uint32_t tone) {
    const auto [w, h] = in.extent;
    const shared::CompositePush p{{w, h}, in.display.low(), in.display.high(), 1 / in.display.gamma, in.gain};
    const reference::CompositeFrame<glm::vec4> frame{in.scene, in.veil, in.glare};
    Picture got_codes(w, h, 3), want(w, h, 3);
    for (uint32_t y = 0; y < h; ++y)
        for (uint32_t x = 0; x < w; ++x) {
            const auto code = reference::composite(frame, {x, y}, tone, in.curve, p);
            for (uint32_t c = 0; c < 3; ++c) {
                got_codes.at(x, y, c) = got[4 * (size_t(y) * w + x) + c];
                want.at(x, y, c) = code[int(c)];
            }
            EXPECT_EQ(got[4 * (size_t(y) * w + x) + 3], 255) << "alpha";
        }
    EXPECT_TRUE(same_codes("tone " + std::to_string(tone), got_codes, want, kBeyond));
}

TEST(Composite, MatchesTheReferenceForEveryOperatorAndSize) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {65, 3}, {131, 67}})
        for (uint32_t tone : kEveryTone) {
            const Inputs in{extent, night_pixels(extent, extent.width), {}, {}, crooked_curve({}), {}};
            expect_reference(composite(rig, in, tone), in, tone);
        }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Composite, MatchesTheReferenceOfAWholeFrame) {
    PassRig rig;
    const VkExtent2D extent{1680, 1050};
    const Inputs in{extent, night_pixels(extent, 1), {}, {}, crooked_curve({}), {}};
    expect_reference(composite(rig, in, shared::kToneCurve), in, shared::kToneCurve);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Composite, AddsBothKindsOfGlare) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {66, 35}})
        for (uint32_t tone : kEveryTone)
            for (uint32_t which : {1u, 2u, 3u}) {
                Inputs in{extent, night_pixels(extent, which), {}, {}, crooked_curve({}), {}, 0.7f};
                if (which & 1) in.veil = night_pixels(extent, 20, -3, 2);
                if (which & 2) {
                    in.glare = night_pixels(quarter(extent), 21, -3, 0);
                    for (auto& g : in.glare) g = glm::round(g * 1024.0f) / 1024.0f;  // exact in a 16-bit float
                }
                expect_reference(composite(rig, in, tone), in, tone);
            }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Composite, OtherDisplaysAndTables) {
    PassRig rig;
    const VkExtent2D extent{40, 30};
    for (const Display& display :
         {Display{10, 0.01f, 2.2f, 0, 0}, Display{1000, 0.5f, 1.8f, 300, 0.02f}, Display{80, 1, 1, 0, 0}})
        for (uint32_t bins : {1u, 17u, 256u}) {
            const Inputs in{extent, night_pixels(extent, bins), {}, {}, crooked_curve(display, bins), display};
            expect_reference(composite(rig, in, shared::kToneCurve), in, shared::kToneCurve);
        }
    // A table that begins below the floor of the logarithm.
    Inputs in{extent, night_pixels(extent, 2, -8, 2), {}, {}, crooked_curve({}), {}};
    in.curve.ln_low = std::log(1e-7f);
    expect_reference(composite(rig, in, shared::kToneCurve), in, shared::kToneCurve);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Composite, WhatIsNotFiniteIsBlack) {
    PassRig rig;
    const VkExtent2D extent{4, 3};
    Inputs in{extent, std::vector<glm::vec4>(12, glm::vec4(50, 50, 50, 1)), {}, {}, crooked_curve({}), {}};
    in.scene[0] = {kNan, 1, 1, 1}, in.scene[1] = {1, kInf, 1, 1}, in.scene[2] = {1, 1, -kInf, 1},
    in.scene[3] = {kInf, -kInf, kNan, 1};
    in.scene[4] = {-5, -5, -5, 1}, in.scene[5] = {90, -1, 20, 1}, in.scene[6] = {-1, -1, 40, 1};
    for (uint32_t tone : kEveryTone) {
        const auto got = composite(rig, in, tone);
        expect_reference(got, in, tone);
        for (size_t i = 0; i < 4 * 3; ++i)
            EXPECT_EQ(got[4 * (i / 3) + i % 3], 0) << "tone " << tone << " pixel " << i / 3;
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Composite, DisplaysShowTheLightThatFallsOnThem) {
    const Display lcd{200, 0.8f, 2.2f, 60, 0.01f};  // Mantiuk et al. 2008, as in pfstools
    EXPECT_NEAR(lcd.low(), reference::display_luminance(0, 200, 0.8, 2.2, 60, 0.01), 1e-6);
    EXPECT_NEAR(lcd.high(), reference::display_luminance(1, 200, 0.8, 2.2, 60, 0.01), 1e-4);
}

TEST(Composite, GreyStaysGreyAndRampsStayMonotone) {
    PassRig rig;
    const VkExtent2D extent{512, 1};
    Inputs in{extent, {}, {}, {}, crooked_curve({}), {}};
    for (int i = 0; i < 512; ++i) in.scene.emplace_back(glm::vec3(std::pow(10.0f, -5 + float(i) / 40)), 1);
    for (uint32_t tone : kEveryTone) {
        const auto got = composite(rig, in, tone);
        for (size_t i = 0; i < 512; ++i) {
            EXPECT_EQ(got[4 * i], got[4 * i + 1]);
            EXPECT_EQ(got[4 * i], got[4 * i + 2]);
            EXPECT_GE(got[4 * i], got[4 * (i ? i - 1 : 0)]) << "tone " << tone;
        }
        EXPECT_LE(got[0], 1);  // 1e-5 cd/m^2
        EXPECT_EQ(got[4 * 511], 255);
    }
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test
