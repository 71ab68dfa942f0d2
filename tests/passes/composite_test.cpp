// Display codes on the device against their reference. SPDX-License-Identifier: MIT
#include "passes/composite_reference.h"

#include "render/passes/composite.h"
#include "support/compare.h"
#include "support/displays.h"
#include "support/texels.h"
#include "support/tones.h"

namespace vesper::test::composite_test {
namespace {

using vision::Display;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

// Of white, beyond half a code that rounding takes: log, exp and pow in float as exactly as Vulkan asks for, and the
// curve's slope. 0.05 of a code of 8 bits, 0.2 of 10.
constexpr double kBeyond = 2e-4;
// What goes towards white is a sum of cubes of which much cancels: some units of the last place of 1, which near black
// are a good part of a code.
constexpr double kCancelled = 3e-6;

struct Inputs {
    VkExtent2D extent;
    std::vector<glm::vec4> scene, glare;  ///< glare: empty for none
    shared::ToneCurve curve;
    Display display;
    float gain = 1;
};

VkExtent2D quarter(VkExtent2D e) { return {(e.width + 3) / 4, (e.height + 3) / 4}; }

render::CompositeInputs inputs_of(PassRig& rig, graph::FrameGraph& graph, const Inputs& in) {
    render::CompositeInputs inputs{rig.image(graph, "scene", render::kSceneFormat, in.extent, in.scene),
                                   graph.upload("curve", std::vector{in.curve}, VK_FORMAT_R32G32B32A32_SFLOAT)};
    if (!in.glare.empty())
        inputs.bloom = rig.image(graph, "glare", render::kBloomFormat, quarter(in.extent), to_halves(in.glare));
    return inputs;
}

/// Codes, RGBA.
std::vector<uint16_t> composite(PassRig& rig, const Inputs& in, uint32_t tone) {
    graph::FrameGraph graph;
    const render::CompositeInputs inputs = inputs_of(rig, graph, in);
    const render::CompositeSettings settings{.tone = tone, .display = in.display, .bloom_gain = in.gain};
    const graph::Resource kept =
        keep<uint32_t>(graph, render::add_composite(rig.frame(graph, in.extent), inputs, settings));
    rig.run(graph);
    std::vector<uint16_t> codes;
    for (const uint32_t word : rig.got<uint32_t>(kept)) {
        for (uint32_t c = 0; c < 3; ++c)
            codes.push_back(uint16_t(word >> c * in.display.bits & in.display.largest_code()));
        codes.push_back(uint16_t(word >> 3 * in.display.bits));
    }
    return codes;
}

void expect_reference(const std::vector<uint16_t>& got, const Inputs& in, uint32_t tone) {
    const auto [w, h] = in.extent;
    const reference::CompositeFrame<glm::vec4> frame{in.scene, in.glare, {w, h}, double(in.gain)};
    Picture got_codes(w, h, 3), want(w, h, 3), rounding(w, h, 3);
    for (uint32_t y = 0; y < h; ++y)
        for (uint32_t x = 0; x < w; ++x) {
            const auto light = reference::composite_light(frame, {x, y}, tone, in.curve, in.display);
            const auto code = reference::code(light, in.display);
            const bool gives_way = (tone & shared::kGamutMask) == shared::kGamutLuminance &&
                                   std::max({light.x, light.y, light.z}) > 1 - shared::kGamutKnee;
            const auto off = gives_way ? reference::code(light + kCancelled, in.display) -
                                             reference::code(light - kCancelled, in.display)
                                       : glm::dvec3(0);
            for (uint32_t c = 0; c < 3; ++c) {
                rounding.at(x, y, c) = off[int(c)];
                got_codes.at(x, y, c) = got[4 * (size_t(y) * w + x) + c];
                want.at(x, y, c) = code[int(c)];
            }
            EXPECT_EQ(got[4 * (size_t(y) * w + x) + 3], in.display.bits == 8 ? 255 : 3) << "alpha";
        }
    EXPECT_TRUE(
        same_codes("tone " + std::to_string(tone), got_codes, want, kBeyond * in.display.largest_code(), rounding));
}

TEST(Composite, MatchesTheReferenceForEveryOperatorAndSize) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {65, 3}, {131, 67}})
        for (uint32_t tone : kEveryTone) {
            const Inputs in{extent, night_pixels(extent, extent.width), {}, crooked_curve_of(tone, {}), {}};
            expect_reference(composite(rig, in, tone), in, tone);
        }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Composite, MatchesTheReferenceOfAWholeFrame) {
    PassRig rig;
    const VkExtent2D extent{1680, 1050};
    const Inputs in{extent, night_pixels(extent, 1), {}, crooked_curve({}), {}};
    expect_reference(composite(rig, in, shared::kToneCurve), in, shared::kToneCurve);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Composite, AddsBloom) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {66, 35}})
        for (uint32_t tone : kEveryTone) {
            Inputs in{extent,
                      night_pixels(extent, 2),
                      night_pixels(quarter(extent), 21, -3, 0),
                      crooked_curve_of(tone, {}),
                      {},
                      0.7f};
            for (auto& g : in.glare) g = glm::round(g * 1024.0f) / 1024.0f;  // exact in a 16-bit float
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
            const Inputs in{extent, night_pixels(extent, bins), {}, crooked_curve(display, bins), display};
            expect_reference(composite(rig, in, shared::kToneCurve), in, shared::kToneCurve);
        }
    // A table that begins below the floor of the logarithm.
    Inputs in{extent, night_pixels(extent, 2, -8, 2), {}, crooked_curve({}), {}};
    in.curve.ln_low = std::log(1e-7f);
    expect_reference(composite(rig, in, shared::kToneCurve), in, shared::kToneCurve);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Composite, WhatIsNotFiniteIsBlack) {
    PassRig rig;
    const VkExtent2D extent{4, 3};
    Inputs in{extent, std::vector<glm::vec4>(12, glm::vec4(50, 50, 50, 1)), {}, crooked_curve({}), {}};
    in.scene[0] = {kNan, 1, 1, 1}, in.scene[1] = {1, kInf, 1, 1}, in.scene[2] = {1, 1, -kInf, 1},
    in.scene[3] = {kInf, -kInf, kNan, 1};
    in.scene[4] = {-5, -5, -5, 1}, in.scene[5] = {90, -1, 20, 1}, in.scene[6] = {-1, -1, 40, 1};
    for (uint32_t tone : kEveryTone) {
        in.curve = crooked_curve_of(tone, {});
        const auto got = composite(rig, in, tone);
        expect_reference(got, in, tone);
        for (size_t i = 0; i < 4 * 3; ++i)
            EXPECT_EQ(got[4 * (i / 3) + i % 3], 0) << "tone " << tone << " pixel " << i / 3;
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Every hue, pure and less so, from dark to far brighter than the display in it.
TEST(Composite, SweepsOfHueAndLuminance) {
    PassRig rig;
    const VkExtent2D extent{121, 75};
    Inputs in{extent, {}, {}, crooked_curve({}), {}};
    in.curve.block[0] = {0, 1, 0, 0};
    for (uint32_t y = 0; y < extent.height; ++y)
        for (uint32_t x = 0; x < extent.width; ++x) {
            const float hue = 6 * float(x) / float(extent.width), purity = 1 - 0.4f * float(y % 3);
            const auto channel = [&](float at) {
                return 1 - purity * glm::clamp(2 - std::abs(std::fmod(hue + at, 6.0f) - 3), 0.0f, 1.0f);
            };
            const glm::vec3 colour(channel(0), channel(4), channel(2));
            in.scene.emplace_back(colour * (0.05f + float(y) / 30), 1);
        }
    for (uint32_t gamut : {shared::kGamutLuminance, shared::kGamutChromaticity, shared::kGamutClip})
        for (const Display& display :
             {Display{}, Display{.primaries = io::kDisplayP3}, Display{.primaries = io::kRec2020}}) {
            in.display = display;
            expect_reference(composite(rig, in, shared::kToneLinear | gamut), in, shared::kToneLinear | gamut);
        }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Composite, DisplaysShowTheLightThatFallsOnThem) {
    const Display lcd{200, 0.8f, 2.2f, 60, 0.01f};  // Mantiuk et al. 2008, as in pfstools
    EXPECT_NEAR(lcd.low(), reference::display_luminance(0, 200, 0.8, 2.2, 60, 0.01), 1e-6);
    EXPECT_NEAR(lcd.high(), reference::display_luminance(1, 200, 0.8, 2.2, 60, 0.01), 1e-4);
}

TEST(Composite, EveryKindOfDisplay) {
    PassRig rig;
    const VkExtent2D extent{70, 40};
    std::vector<Display> displays = every_kind_of_display();
    displays.push_back({.eotf = vision::Eotf::Srgb, .bits = 10, .primaries = io::kDisplayP3});
    displays.push_back({.primaries = {{0.66, 0.32}, {0.28, 0.65}, {0.15, 0.05}, {0.30, 0.32}}});
    for (const Display& display : displays)
        for (uint32_t tone : kEveryTone) {
            Inputs in{extent, night_pixels(extent, tone), {}, crooked_curve_of(tone, display), display};
            expect_reference(composite(rig, in, tone), in, tone);
            in.glare = night_pixels(quarter(extent), 5, -3, 0);
            for (auto& g : in.glare) g = glm::round(g * 1024.0f) / 1024.0f;
            expect_reference(composite(rig, in, tone), in, tone);
        }
    EXPECT_EQ(rig.complaints(), "");
}

// The operator without a curve passes light on as it is: so codes are exactly the nearest ones, for lights that lie
// densely over [0, 1], evenly and by decades, and one float below and above each light where a code begins.
TEST(Composite, CodesAreTheNearest) {
    PassRig rig;
    for (Display display : every_kind_of_display()) {
        display.primaries = io::kRec709;
        std::vector<float> lights{0, -0.0f, 1};
        for (int i = 0; i <= 20000; ++i)
            lights.push_back(float(i) / 20000), lights.push_back(std::pow(10.0f, -9 * float(i) / 20000));
        const vision::DisplayCurve curve(display);
        const double black = double(display.black), range = double(display.peak) - black;
        for (double code = 0.5; code < display.largest_code(); ++code) {
            const float at = float((curve.emitted(code / display.largest_code()) - black) / range);
            for (float light : {std::nextafter(at, 0.0f), at, std::nextafter(at, 1.0f)}) lights.push_back(light);
        }
        lights.resize((lights.size() + 63) / 64 * 64, 0.5f);
        Inputs in{{64, uint32_t(lights.size() / 64)}, {}, {}, crooked_curve(display), display};
        for (float light : lights) in.scene.emplace_back(light, light, light, 1);
        const auto got = composite(rig, in, shared::kToneLdr);
        size_t wrong = 0;
        for (size_t i = 0; i < lights.size(); ++i) {
            const double want = reference::code(glm::dvec3(double(lights[i])), display).x;
            // At the very edge, half a float of the light decides.
            const double doubt = want - std::floor(want) - 0.5;
            if (got[4 * i] != std::lround(want) && std::abs(doubt) > 1e-4) ++wrong;
        }
        EXPECT_EQ(wrong, 0u) << int(display.eotf) << " with " << display.bits << " bits";
    }
    EXPECT_EQ(rig.complaints(), "");
}

// What a projection shows: the light that codes are of.
TEST(Composite, LightThatIsShownMatchesTheReference) {
    PassRig rig;
    for (size_t i = 0; i < std::size(kEveryTone); ++i)
        for (const VkExtent2D extent : {VkExtent2D{1, 1}, {37, 21}}) {
            const uint32_t tone = kEveryTone[i];
            const Display display = i % 2 ? Display{.primaries = io::kRec2020} : Display{};
            Inputs in{extent, night_pixels(extent, tone), {}, crooked_curve_of(tone, display), display, 0.7f};
            if (extent.width > 1) in.scene[5] = {kNan, 1, 1, 1}, in.scene[6] = {1, kInf, 1, 1};
            if (i % 4 < 2) in.glare = night_pixels(quarter(extent), 21, -3, 0);
            for (auto& g : in.glare) g = glm::round(g * 1024.0f) / 1024.0f;
            graph::FrameGraph graph;
            const render::CompositeInputs inputs = inputs_of(rig, graph, in);
            const graph::Resource kept = keep<glm::vec4>(
                graph, render::add_shown_light(rig.frame(graph, extent), inputs,
                                               {.tone = tone, .display = display, .bloom_gain = in.gain}));
            rig.run(graph);
            const auto got = rig.got<glm::vec4>(kept);
            const reference::CompositeFrame<glm::vec4> frame{
                in.scene, in.glare, {extent.width, extent.height}, double(in.gain)};
            Picture got_light(extent.width, extent.height, 3), want = got_light;
            for (uint32_t k = 0; k < got.size(); ++k) {
                const glm::dvec3 light =
                    reference::composite_light(frame, {k % extent.width, k / extent.width}, tone, in.curve, display);
                for (uint32_t c = 0; c < 3; ++c) {
                    got_light.values[3 * k + c] = std::clamp(double(got[k][int(c)]), 0.0, 1.0);
                    want.values[3 * k + c] = std::clamp(light[int(c)], 0.0, 1.0);
                }
            }
            // As for codes: log, exp and pow in float, and the curve's slope, of white.
            EXPECT_TRUE(same_light("shown " + std::to_string(tone), got_light, want, {kBeyond, 1}));
        }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Composite, LightOfTheDisplayWithoutItsLimits) {
    PassRig rig;
    const VkExtent2D extent{37, 21};
    for (uint32_t tone : kEveryTone) {
        Inputs in{extent, night_pixels(extent, tone), {}, crooked_curve_of(tone, {}), {}};
        in.scene[5] = {kNan, 1, 1, 1}, in.scene[6] = {1, kInf, 1, 1}, in.scene[7] = {-5, -5, -5, 1},
        in.scene[8] = {90, -1, 20, 1};
        graph::FrameGraph graph;
        const render::CompositeInputs inputs = inputs_of(rig, graph, in);
        const graph::Resource kept = keep<glm::vec4>(
            graph, render::add_display_light(rig.frame(graph, extent), inputs, {.tone = tone, .display = in.display}));
        rig.run(graph);
        const auto got = rig.got<glm::vec4>(kept);
        Picture got_light(extent.width, extent.height, 3), want = got_light;
        for (size_t i = 0; i < got.size(); ++i) {
            const auto light = reference::display_light(glm::dvec3(in.scene[i]), tone, in.curve, in.display);
            for (size_t c = 0; c < 3; ++c)
                got_light.values[3 * i + c] = double(got[i][int(c)]), want.values[3 * i + c] = light[int(c)];
        }
        // log and exp in float, as the curve is steep, and the sum with the black level; powers of colour beside that,
        // or a matrix whose terms cancel.
        const uint32_t form = tone & shared::kToneForm;
        EXPECT_TRUE(same_light("light " + std::to_string(tone), got_light, want,
                               {form == shared::kToneColour || form == shared::kToneRods ? 5e-5 : 1e-5, 0.1}));
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Composite, GreyStaysGreyAndRampsStayMonotone) {
    PassRig rig;
    const VkExtent2D extent{512, 1};
    Inputs in{extent, {}, {}, crooked_curve({}), {}};
    for (int i = 0; i < 512; ++i) in.scene.emplace_back(glm::vec3(std::pow(10.0f, -5 + float(i) / 40)), 1);
    for (uint32_t tone : kEveryTone) {
        in.curve = crooked_curve_of(tone, {});
        const auto got = composite(rig, in, tone);
        for (size_t i = 0; i < 512; ++i) {
            EXPECT_TRUE((tone & shared::kToneForm) == shared::kToneRods ||
                        (got[4 * i] == got[4 * i + 1] && got[4 * i] == got[4 * i + 2]))
                << "rods may have a tint";
            EXPECT_GE(got[4 * i], got[4 * (i ? i - 1 : 0)]) << "tone " << tone;
        }
        EXPECT_LE(got[0], 1);  // 1e-5 cd/m^2
        EXPECT_EQ(std::max({got[4 * 511], got[4 * 511 + 1], got[4 * 511 + 2]}), 255) << "tone " << tone;
    }
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::composite_test
