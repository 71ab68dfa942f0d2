// Scene images and tone curves to test the display side with. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <glm/glm.hpp>

#include "graph/frame_graph.h"
#include "shared/gamut.h"
#include "shared/tone.h"
#include "vision/display.h"

namespace vesper::test {

constexpr uint32_t kEveryTone[]{shared::kToneCurve,
                                shared::kToneReinhard,
                                shared::kToneLinear,
                                shared::kToneLdr,
                                shared::kToneColour,
                                shared::kToneRods,
                                shared::kToneCurve | shared::kToneColourLoss,
                                shared::kToneLinear | shared::kTonePurkinje,
                                shared::kToneReinhard | shared::kToneColourLoss | shared::kTonePurkinje,
                                shared::kToneColour | shared::kTonePhotopicRods,
                                shared::kToneRods | shared::kTonePhotopicRods,
                                shared::kToneCurve | shared::kGamutChromaticity,
                                shared::kToneCurve | shared::kGamutClip,
                                shared::kToneReinhard | shared::kGamutChromaticity,
                                shared::kToneLinear | shared::kGamutClip,
                                shared::kToneColour | shared::kGamutChromaticity,
                                shared::kToneRods | shared::kGamutClip};

/// A crooked table from 0.01 to 1e4 cd/m^2.
inline shared::ToneCurve crooked_curve(const vision::Display& display, uint32_t bins = 100) {
    shared::ToneCurve c{};
    c.adaptation = c.log_average = 0.7f, c.maximum = 3000;
    c.ln_low = std::log(0.01f), c.bins_per_ln = float(bins) / std::log(1e6f), c.bins = float(bins);
    const double low = std::log(double(display.low())), range = std::log(double(display.high())) - low;
    double sum = 0;
    std::vector<double> steps;
    for (uint32_t i = 0; i < bins; ++i) steps.push_back(i % 7 == 3 ? 0 : 1 + std::sin(0.3 * i)), sum += steps.back();
    double at = 0;
    for (uint32_t i = 0; i <= bins; ++i) {
        c.node[i] = {float(low + range * at / sum), 0.3f + float(i) / float(bins), 0.5f + 0.5f * std::sin(float(i)), 0};
        if (i < bins) at += steps[i];
    }
    return c;
}

/// The same for kToneColour: responses of cones and rods, as crooked.
inline shared::ToneCurve crooked_responses(const vision::Display& display, uint32_t bins = 100) {
    shared::ToneCurve c = crooked_curve(display, bins);
    c.block[0] = {-0.01f, 5.17f, 0, 0};
    for (uint32_t i = 0; i <= bins; ++i) {
        const float along =
            (c.node[i].x - std::log(display.low())) / (std::log(display.high()) - std::log(display.low()));
        c.node[i] = {0.7f * along, c.node[i].y, 0.3f * float(i) / float(bins), 0};
    }
    return c;
}

/// For any form: also Reinhard with white at 3000, linear from 0.05 to 80.
inline shared::ToneCurve crooked_curve_of(uint32_t tone, const vision::Display& display) {
    const uint32_t form = tone & shared::kToneForm;
    if (form == shared::kToneColour) return crooked_responses(display);
    shared::ToneCurve c = crooked_curve(display);
    if (form == shared::kToneReinhard) {
        const float scale = 0.18f / 0.7f;
        c.block[0] = {scale, 1 / (scale * 3000 * scale * 3000), 0, 0};
    } else if (form == shared::kToneLinear || form == shared::kToneRods) {
        c.block[0] = {0.05f, 1 / 79.95f, 0, 0};
    }
    if (form == shared::kToneRods) {
        c.block[1] = {0.2f, 0.1f, 0.4f, 0};
        c.block[2] = {0.8f, 0.15f, 0, 0}, c.block[3] = {0.02f, 1.1f, -0.03f, 0}, c.block[4] = {0, -0.1f, 1.7f, 0};
    }
    return c;
}

/// Pixels from 1e-4 to 1e8 cd/m^2, saturated and grey, some black.
inline std::vector<glm::vec4> night_pixels(VkExtent2D extent, uint32_t seed, float log10_low = -4,
                                           float log10_high = 8) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> decades(log10_low, log10_high), unit(0, 1);
    std::vector<glm::vec4> pixels;
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        const glm::vec3 tint =
            i % 3 == 0 ? glm::vec3(1) : glm::vec3(unit(random), unit(random), i % 5 == 0 ? 0.0f : unit(random));
        pixels.emplace_back(i % 17 == 0 ? glm::vec3(0) : tint * std::pow(10.0f, decades(random)), 1);
    }
    return pixels;
}

}  // namespace vesper::test
