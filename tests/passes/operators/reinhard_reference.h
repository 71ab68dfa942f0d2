// Reinhard, Stark, Shirley and Ferwerda 2002, and Reinhard 2003. SPDX-License-Identifier: MIT
#pragma once

#include "passes/operators/operator_reference.h"

namespace vesper::reference {

/// ln of the luminance below which a part of the votes is, linear within a bin.
inline double percentile(const std::vector<double>& share, double part, const shared::ToneParameters& p) {
    const double all = std::accumulate(share.begin(), share.end(), 0.0);
    double below = 0;
    for (size_t i = 0; i < share.size(); below += share[i++])
        if (below / all < part && (below + share[i]) / all >= part)
            return p.ln_low + (double(i) + (part * all - below) / share[i]) / p.bins_per_ln;
    return p.ln_low;
}

inline void reinhard_frame(const OperatorFrame& f, Adapted& out) {
    const shared::ToneParameters& p = f.in.parameters;
    double key = p.settings[0].x;
    double white = key / f.log_average * (p.settings[0].y > 0 ? double(p.settings[0].y) : std::max(f.maximum, kFloor));
    if (p.settings[0].z != 0) {  // Reinhard 2003, Eq. 4 and 5
        const double low = percentile(out.share, 0.01, p) / std::log(2),
                     high = percentile(out.share, 0.99, p) / std::log(2);
        const double average = std::log2(f.log_average), span = std::max(high - low, 1e-3);
        key = 0.18 * std::pow(4, (2 * average - low - high) / span);
        white = 1.5 * std::exp2(span - 5);
    }
    out.tone.block[0] = {float(key / f.log_average), float(1 / (white * white)), 0, 0};
}

}  // namespace vesper::reference
