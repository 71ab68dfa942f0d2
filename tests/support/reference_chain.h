// The whole way from luminance to display codes, in double, put together from the references of the passes.
// SPDX-License-Identifier: MIT
#pragma once

#include "passes/adapt_reference.h"
#include "passes/bands_reference.h"
#include "passes/colours_reference.h"
#include "passes/composite_reference.h"
#include "passes/histogram_reference.h"
#include "render/tone_chain.h"

namespace vesper::test {

/// Codes before rounding, RGB, in [0, 255]; without glare. `previous` is what the eye remembers.
inline std::vector<glm::dvec3> reference_codes(std::span<const glm::vec4> scene, VkExtent2D extent,
                                               const render::ToneChainSettings& settings, uint32_t tone,
                                               uint32_t foveal_level, float seconds, shared::EyeState previous = {}) {
    const auto levels = reference::pyramid(scene, extent.width, extent.height);
    const auto& level = levels.at(foveal_level - 1);
    const render::HistogramSettings& bins = settings.histogram;
    const vision::Display& display = settings.display;
    const render::OperatorInfo& op = render::operator_info(settings.tone_operator);
    const bool fine = bins.fine && foveal_level > 1, overlaps = fine && bins.overlap;
    const uint32_t halvings = overlaps ? std::min(foveal_level - 1, 3u) : 0;
    const reference::PyramidLevel texels =
        reference::overlapping(levels.at(foveal_level - halvings - 1), 1u << halvings);
    const auto push_of = [&](const reference::PyramidLevel& l, uint32_t k, bool census, uint32_t overlap) {
        return shared::HistogramPush{
            {extent.width, extent.height},
            {l.width, l.height},
            k,
            bins.bins,
            bins.ln_low(),
            bins.bins_per_ln(),
            uint32_t(std::clamp<uint64_t>(0xf0000000u / (uint64_t(2) * extent.width * extent.height), 1, 4096)),
            bins.split ? 1u : 0u,
            census ? 1u : 0u,
            overlap};
    };
    reference::Votes votes;
    reference::vote(votes, std::span<const glm::dvec4>(texels.texels),
                    push_of(texels, foveal_level, !overlaps, 2 * halvings));
    if (fine) reference::vote(votes, std::span<const glm::dvec4>(levels[0].texels), push_of(levels[0], 1, overlaps, 0));
    shared::Histogram histogram = votes.counted;
    for (size_t i = 0; i < votes.count.size(); ++i) histogram.count[i] = uint32_t(std::lround(votes.count[i]));
    const shared::ToneParameters parameters = render::tone_parameters(
        op, bins, settings.tone, display, {foveal_level, {level.width, level.height}, extent}, seconds);
    const auto adapted = reference::adapt(
        {histogram, levels.back().texels.at(0), level, previous, parameters, settings.tone.observer, op.tone_operator,
         op.chromatic ? reference::colour_tiles(scene, extent.width, extent.height) : reference::PyramidLevel{}});
    std::vector<glm::vec4> banded(scene.begin(), scene.end());
    if (op.bands) {
        std::vector<double> luminance;
        for (const glm::vec4& p : scene) luminance.push_back(reference::luminance(glm::dvec3(p)));
        const auto bands =
            reference::bands(luminance, extent.width, extent.height, levels, foveal_level, adapted.tone, parameters);
        for (size_t i = 0; i < banded.size(); ++i)
            if (reference::finite(glm::dvec3(scene[i])))
                banded[i] = glm::vec4(
                    glm::vec3(reference::banded(glm::dvec3(scene[i]), std::exp(bands.shown[i]), tone, adapted.tone)),
                    1);
        tone = shared::kToneLinear | (tone & shared::kGamutMask);
    }
    const reference::CompositeFrame<glm::vec4> frame{banded, {}, {extent.width, extent.height}};
    std::vector<glm::dvec3> codes;
    for (uint32_t y = 0; y < extent.height; ++y)
        for (uint32_t x = 0; x < extent.width; ++x)
            codes.push_back(reference::composite(frame, {x, y}, tone, adapted.tone, display));
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
