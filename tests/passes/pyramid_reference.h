// Area means of luminance over squares of 2^k pixels, each straight from the image. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "shared/luminance.h"

namespace vesper::reference {

using glm::dvec2, glm::dvec3, glm::dvec4;

/// Luminance below which logarithms do not go, cd/m^2.
constexpr double kFloor = 1e-4;

/// Relative luminance of linear Rec. 709 (ITU-R BT.709-6, item 3.2).
inline double luminance(dvec3 rgb) { return 0.212639 * rgb.x + 0.715169 * rgb.y + 0.072192 * rgb.z; }

/// False for a pixel with a NaN or an infinity in any channel.
inline bool finite(dvec3 rgb) { return std::isfinite(rgb.x) && std::isfinite(rgb.y) && std::isfinite(rgb.z); }

/// One level: mean luminance, finite pixels, mean ln luminance, largest luminance (shared/luminance.h).
struct PyramidLevel {
    uint32_t width = 0, height = 0;
    std::vector<dvec4> texels;

    const dvec4& at(uint32_t x, uint32_t y) const { return texels[size_t(y) * width + x]; }
};

/// Pixels of the image that texel (x, y) of level k covers.
inline uint32_t covered(uint32_t width, uint32_t height, uint32_t level, uint32_t x, uint32_t y) {
    const auto span = [level](uint32_t size, uint32_t i) {
        const uint64_t begin = uint64_t(i) << level, end = std::min<uint64_t>(uint64_t(i + 1) << level, size);
        return uint32_t(end > begin ? end - begin : 0);
    };
    return span(width, x) * span(height, y);
}

/// Level k >= 1 of an image of RGB luminances (rows from the top). Logarithms of L + epsilon if that is not 0.
template <class Rgb>
PyramidLevel pyramid_level(std::span<const Rgb> image, uint32_t width, uint32_t height, uint32_t level,
                           double epsilon = 0) {
    const uint64_t side = uint64_t(1) << level;
    PyramidLevel out;
    out.width = uint32_t((width + side - 1) / side);
    out.height = uint32_t((height + side - 1) / side);
    for (uint32_t y = 0; y < out.height; ++y)
        for (uint32_t x = 0; x < out.width; ++x) {
            double sum = 0, sum_ln = 0, count = 0, largest = -std::numeric_limits<double>::infinity();
            for (uint64_t j = y * side; j < std::min<uint64_t>((y + 1) * side, height); ++j)
                for (uint64_t i = x * side; i < std::min<uint64_t>((x + 1) * side, width); ++i) {
                    const auto& p = image[j * width + i];
                    const dvec3 rgb(p.x, p.y, p.z);
                    if (!finite(rgb)) continue;
                    const double l = luminance(rgb);
                    sum += l, sum_ln += std::log(epsilon > 0 ? std::max(l, 0.0) + epsilon : std::max(l, kFloor)),
                        count += 1, largest = std::max(largest, l);
                }
            out.texels.push_back(count > 0 ? dvec4(sum / count, count, sum_ln / count, largest) : dvec4(0));
        }
    return out;
}

/// Levels 1, 2, ... until one texel is left; one level for a single pixel.
template <class Rgb>
std::vector<PyramidLevel> pyramid(std::span<const Rgb> image, uint32_t width, uint32_t height, double epsilon = 0) {
    std::vector<PyramidLevel> levels;
    do levels.push_back(pyramid_level(image, width, height, uint32_t(levels.size()) + 1, epsilon));
    while (levels.back().width > 1 || levels.back().height > 1);
    return levels;
}

}  // namespace vesper::reference
