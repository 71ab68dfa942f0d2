// Weights between a pixel and the levels of the glare pyramid, along one axis. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vision/scatter_fit.h"

namespace vesper::vision {

/// Weights of the texels of a level, from the one at `first` on.
struct CascadeTaps {
    int first = 0;
    std::vector<double> weights;
    double at(int i) const { return i < first || i >= first + int(weights.size()) ? 0 : weights[size_t(i - first)]; }
};

/// One level up; `gain` 1/32 on the way up (means), 1/16 on the way down (sums to one).
inline CascadeTaps coarser(const CascadeTaps& fine, double gain) {
    const auto half_down = [](int i) { return i >= 0 ? i / 2 : -((1 - i) / 2); };
    const int last = fine.first + int(fine.weights.size()) - 1;
    CascadeTaps taps{half_down(fine.first - 2), {}};
    for (int j = taps.first; 2 * j - 2 <= last; ++j) {
        double sum = 0;
        for (int k = 0; k < 6; ++k) sum += kScatterFilter[size_t(k)] * fine.at(2 * j - 2 + k);
        taps.weights.push_back(gain * sum);
    }
    return taps;
}

/// Weights from a pixel to the texels of levels 0 .. `levels` (given), and from these to the pixel (taken).
inline std::vector<CascadeTaps> cascade(int pixel, int levels, double gain) {
    std::vector<CascadeTaps> all{{pixel, {1.0}}};
    for (int l = 0; l < levels; ++l) all.push_back(coarser(all.back(), gain));
    return all;
}
inline std::vector<CascadeTaps> given(int pixel, int levels) { return cascade(pixel, levels, 1.0 / 32); }
inline std::vector<CascadeTaps> taken(int pixel, int levels) { return cascade(pixel, levels, 1.0 / 16); }

}  // namespace vesper::vision
