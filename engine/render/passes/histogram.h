// How often each luminance occurs. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/passes/pyramid.h"
#include "shared/tone.h"

namespace vesper::render {

struct HistogramSettings {
    uint32_t bins = 100;  ///< 1 .. 256
    float low = 1e-4f;    ///< cd/m^2, from which luminance is counted
    float high = 1e6f;    ///< cd/m^2, up to which it is
    bool split = true;    ///< a vote is shared by the two nearest bins, so that none jumps from one to the next
    bool fine = true;     ///< half of all votes are those of level 1, so that small lamps have bins of their own
    bool overlap =
        true;  ///< with fine votes: texels of the level itself overlap, so that the place of their grid does not matter
    uint64_t electorate = 0;  ///< px of all pictures whose votes are added, so that all have as many; 0: of this one
    float spread = 0.1f;      ///< split votes: standard deviation of a vote in the curve, log10, for any number of bins

    /// Of the curve: whole ones per bin, up to kMaxBins.
    uint32_t steps_per_bin() const { return split ? shared::kMaxBins / std::clamp(bins, 1u, shared::kMaxBins) : 1; }
    /// Bins between the knots of the B-spline (of variance window^2 / 3) that, with a vote's share in two bins (1/6),
    /// makes the spread of the vote.
    float window() const {
        const float spread_in_bins = spread * float(bins) / decades();
        return split ? std::sqrt(std::max(3 * (spread_in_bins * spread_in_bins - 1.0f / 6), 1.0f)) : 0;
    }
    float ln_low() const { return float(std::log10(double(low))) * std::numbers::ln10_v<float>; }
    float bins_per_ln() const { return float(bins) / (decades() * std::numbers::ln10_v<float>); }
    float decades() const { return float(std::log10(double(high))) - float(std::log10(double(low))); }
};

/// Votes of ln luminance over the texels of one pyramid level (1-based), and of level 1 as settings say. A
/// shared::Histogram.
graph::Resource add_histogram(const FrameContext& frame, const Pyramid& pyramid, uint32_t level,
                              const HistogramSettings& settings);

}  // namespace vesper::render
