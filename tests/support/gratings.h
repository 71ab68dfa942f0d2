// Pictures of waves and discs. SPDX-License-Identifier: MIT
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

/// A square picture of a wave of `cycles` along its side, of this contrast in its middle, under a Gaussian envelope of
/// standard deviation `sigma`, px.
inline std::vector<float> gabor(uint32_t side, double cycles, double sigma, double mean, double contrast) {
    std::vector<float> picture;
    const double middle = side / 2.0;
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            const double envelope = std::exp(-0.5 * std::pow(std::hypot(x - middle, y - middle) / sigma, 2));
            const double wave = std::cos(2 * std::numbers::pi * cycles * (x - middle) / side);
            picture.push_back(float(mean * (1 + contrast * envelope * wave)));
        }
    return picture;
}

/// A square picture of a disc of this radius, px, in the middle of a background, cd/m^2, so much brighter; pixels at
/// its edge hold their share of it.
inline std::vector<float> disc(uint32_t side, double radius, double background, double contrast) {
    std::vector<float> picture;
    const double middle = side / 2.0;
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            double inside = 0;
            for (int i = 0; i < 64; ++i)
                inside += std::hypot(x + (i % 8 + 0.5) / 8 - middle, y + (i / 8 + 0.5) / 8 - middle) < radius;
            picture.push_back(float(background * (1 + contrast * inside / 64)));
        }
    return picture;
}

}  // namespace vesper::test
