// Histogram of ln luminance over the texels of a pyramid level. SPDX-License-Identifier: MIT
#pragma once

#include "passes/pyramid_reference.h"

namespace vesper::reference {

/// Position on the axis of bins, before rounding down and clamping.
inline double bin_position(double luminance, const shared::HistogramPush& p) {
    if (!(luminance > 0)) return -std::numeric_limits<double>::infinity();
    return (std::log(luminance) - p.ln_low) * double(p.bins_per_ln);
}

inline uint32_t bin_at(double position, uint32_t bins) {
    return uint32_t(std::clamp(std::floor(position), 0.0, double(bins) - 1));
}

/// Counts as the pass must give them, with the votes that rounding could put on either side of a bin's edge.
struct HistogramBounds {
    shared::Histogram exact{};
    std::vector<uint32_t> low, high;  ///< per bin: certain votes, and those with every doubtful one

    /// True if `got` has the right totals, and every bin between its bounds.
    bool admits(const shared::Histogram& got) const {
        if (got.finite != exact.finite || got.non_finite != exact.non_finite) return false;
        uint64_t sum = 0;
        for (size_t i = 0; i < low.size(); ++i) {
            if (got.count[i] < low[i] || got.count[i] > high[i]) return false;
            sum += got.count[i];
        }
        for (size_t i = low.size(); i < shared::kMaxBins; ++i)
            if (got.count[i] != 0) return false;
        return sum == exact.finite;  // each pixel once
    }
};

/// Every texel votes with its finite pixels. `doubt`: part of a bin by which a texel's position may be rounded.
template <class Texel>
HistogramBounds histogram(std::span<const Texel> level, const shared::HistogramPush& p, double doubt = 0) {
    HistogramBounds out;
    out.low.resize(p.bins), out.high.resize(p.bins);
    for (uint32_t y = 0; y < p.level_size.y; ++y)
        for (uint32_t x = 0; x < p.level_size.x; ++x) {
            const auto& texel = level[size_t(y) * p.level_size.x + x];
            const uint32_t votes = uint32_t(texel.y);
            out.exact.finite += votes;
            out.exact.non_finite += covered(p.image_size.x, p.image_size.y, p.level, x, y) - votes;
            if (votes == 0) continue;
            const double at = bin_position(texel.x, p);
            out.exact.count[bin_at(at, p.bins)] += votes;
            const uint32_t first = bin_at(at - doubt, p.bins), last = bin_at(at + doubt, p.bins);
            if (first == last) out.low[first] += votes;
            for (uint32_t bin = first; bin <= last; ++bin) out.high[bin] += votes;
        }
    return out;
}

}  // namespace vesper::reference
