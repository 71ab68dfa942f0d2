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

/// Votes in double, as the pass must give them but for rounding.
struct Votes {
    shared::Histogram counted{};  ///< finite, non_finite, votes; not count
    std::vector<double> count;    ///< per bin

    /// True if `got` has the right totals, every vote once, and every bin within `allowed` votes.
    bool admits(const shared::Histogram& got, double allowed) const {
        if (got.finite != counted.finite || got.non_finite != counted.non_finite || got.votes != counted.votes)
            return false;
        uint64_t sum = 0;
        for (size_t i = 0; i < shared::kMaxBins; ++i) {
            if (std::abs(got.count[i] - (i < count.size() ? count[i] : 0)) > (i < count.size() ? allowed : 0))
                return false;
            sum += got.count[i];
        }
        return sum == counted.votes;
    }
};

/// Texels of side x side ones of a level, at every place where at least one of them is.
inline PyramidLevel overlapping(const PyramidLevel& level, uint32_t side) {
    PyramidLevel out{level.width + side - 1, level.height + side - 1, {}};
    for (uint32_t y = 0; y < out.height; ++y)
        for (uint32_t x = 0; x < out.width; ++x) {
            dvec4 sum(0);
            for (uint32_t v = y >= side ? y - side + 1 : 0; v <= std::min(y, level.height - 1); ++v)
                for (uint32_t u = x >= side ? x - side + 1 : 0; u <= std::min(x, level.width - 1); ++u) {
                    const dvec4 t = level.at(u, v);
                    sum.x += t.x * t.y, sum.y += t.y;
                }
            out.texels.push_back({sum.y > 0 ? sum.x / sum.y : 0, sum.y, 0, 0});
        }
    return out;
}

/// Every texel has `votes` for each of its finite pixels: one bin, or the two whose middles are nearest, linearly.
template <class Texel>
void vote(Votes& out, std::span<const Texel> level, const shared::HistogramPush& p) {
    out.count.resize(p.bins);
    for (uint32_t y = 0; y < p.level_size.y; ++y)
        for (uint32_t x = 0; x < p.level_size.x; ++x) {
            const auto& texel = level[size_t(y) * p.level_size.x + x];
            const uint32_t pixels = uint32_t(texel.y);
            if (p.census)
                out.counted.finite += pixels,
                    out.counted.non_finite += covered(p.image_size.x, p.image_size.y, p.level, x, y) - pixels;
            if (pixels == 0) continue;
            const double votes = std::floor(double(pixels) * p.votes / double(1u << p.overlap) + 0.5),
                         at = bin_position(texel.x, p);
            out.counted.votes += uint32_t(votes);
            if (p.split) {
                const double middle = std::clamp(at - 0.5, 0.0, p.bins - 1.0);
                const uint32_t bin = bin_at(middle, p.bins);
                out.count[bin] += votes * (1 - (middle - bin));
                if (bin + 1 < p.bins) out.count[bin + 1] += votes * (middle - bin);
            } else
                out.count[bin_at(at, p.bins)] += votes;
        }
}

}  // namespace vesper::reference
