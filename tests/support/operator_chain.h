// An operator on the device against its reference, on pictures that are hard to get right. SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/tone_mapper.h"
#include "support/reference_chain.h"
#include "support/tones.h"

namespace vesper::test {

/// Every 11th pixel is not a number or infinite.
inline std::vector<glm::vec4> damaged_pixels(VkExtent2D extent) {
    std::vector<glm::vec4> pixels = night_pixels(extent, extent.width, -3, 4);
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinite = std::numeric_limits<float>::infinity();
    for (size_t i = 5; i < pixels.size(); i += 11) pixels[i][int(i % 3)] = i % 2 ? kNan : kInfinite;
    return pixels;
}

/// Pictures of awkward sizes with damaged pixels, and one without any light: codes are those of the reference.
inline void expect_reference(render::Operator wanted, const render::OperatorSettings& of_operators = {}) {
    std::string complaints;
    gpu::Device device(
        {.select = "", .validation = true, .on_message = [&](const std::string& m) { complaints += m + "\n"; }});
    render::ToneMapper mapper(device);
    render::ToneChainSettings settings;
    settings.tone_operator = wanted;
    settings.tone.operators = of_operators;
    for (const bool dark : {false, true})
        for (const VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {66, 35}, {131, 67}}) {
            auto pixels = damaged_pixels(extent);
            if (dark) pixels.assign(pixels.size(), glm::vec4(0, 0, 0, 1));
            const std::span<const float> rgba(&pixels.front().x, pixels.size() * 4);
            mapper.reset_adaptation();
            const render::ToneMapped got =
                mapper.map(settings, {.extent = extent, .values = rgba, .channels = 4}, 0, {});
            const uint32_t tone = render::operator_info(wanted).form;
            const auto want = reference_codes(pixels, extent, settings, tone, got.foveal_level, 0);
            EXPECT_EQ(pixels_off(got.display, want), 0u)
                << extent.width << " x " << extent.height << (dark ? ", dark" : "");
        }
    EXPECT_EQ(complaints, "");
}

}  // namespace vesper::test
