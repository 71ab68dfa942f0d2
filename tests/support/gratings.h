// Pictures of waves. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace vesper::test {

/// A square picture of `u` and `v` cycles along its sides about a mean, cd/m^2; contrast is amplitude over mean.
inline std::vector<float> grating(uint32_t side, double u, double v, double mean, double contrast) {
    std::vector<float> picture;
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x)
            picture.push_back(float(mean * (1 + contrast * std::cos(2 * std::numbers::pi * (u * x + v * y) / side))));
    return picture;
}

}  // namespace vesper::test
