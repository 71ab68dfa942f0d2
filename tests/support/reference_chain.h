// The whole way from luminance to display codes, in double, put together from the references of the passes.
// SPDX-License-Identifier: MIT
#pragma once

#include "passes/adapt_reference.h"
#include "passes/composite_reference.h"
#include "passes/histogram_reference.h"
#include "tone_chain.h"

namespace vesper::test {

/// Codes before rounding, RGB, in [0, 255]; without glare. `previous` is what the eye remembers.
inline std::vector<glm::dvec3> reference_codes(std::span<const glm::vec4> scene, VkExtent2D extent, const ToneChainSettings& settings,
                                               uint32_t tone, uint32_t foveal_level, float seconds, shared::EyeState previous = {}) {
    const auto levels = reference::pyramid(scene, extent.width, extent.height);
    const auto& level = levels.at(foveal_level - 1);
    const HistogramSettings& bins = settings.histogram;
    const Display& display = settings.display;
    const shared::HistogramPush votes{{extent.width, extent.height}, {level.width, level.height}, foveal_level, bins.bins, bins.ln_low(), bins.bins_per_ln()};
    const shared::AdaptPush push{bins.bins, bins.ln_low(), bins.bins_per_ln(), display.low(), display.high(), settings.tone.key, settings.tone.white,
                                 settings.tone.linear_low, settings.tone.linear_high, seconds};
    const auto histogram = reference::histogram(std::span<const glm::dvec4>(level.texels), votes).exact;
    const auto adapted = reference::adapt(histogram, levels.back().texels.at(0), previous, push);
    const reference::CompositeFrame<glm::vec4> frame{scene, {}, {}, {extent.width, extent.height}};
    std::vector<glm::dvec3> codes;
    for (uint32_t y = 0; y < extent.height; ++y)
        for (uint32_t x = 0; x < extent.width; ++x) codes.push_back(reference::composite(frame, {x, y}, tone, adapted.tone, display));
    return codes;
}

/// How many pixels have a channel more than one code away from the reference.
inline size_t pixels_off(std::span<const uint8_t> rgba, std::span<const glm::dvec3> want) {
    size_t off = 0;
    for (size_t i = 0; i < want.size(); ++i) {
        bool far = false;
        for (int c = 0; c < 3; ++c) far |= std::abs(rgba[4 * i + size_t(c)] - std::round(want[i][c])) > 1;
        off += far;
    }
    return off;
}

}  // namespace vesper::test
