// Loss of acuity in double. SPDX-License-Identifier: MIT
#pragma once

#include "passes/pyramid_reference.h"
#include "vision/thresholds.h"

namespace vesper::reference {

/// Mean luminance of a level at the middle of a pixel, linear between the middles of texels, constant beyond the
/// outermost.
inline double luminance_at(const PyramidLevel& level, uint32_t k, uint32_t x, uint32_t y) {
    const auto along = [k](uint32_t i, uint32_t size) {
        return std::clamp((i + 0.5) / double(1u << k) - 0.5, 0.0, size - 1.0);
    };
    const double u = along(x, level.width), v = along(y, level.height);
    double sum = 0;
    for (uint32_t j = 0; j < level.height; ++j)
        for (uint32_t i = 0; i < level.width; ++i) {
            const double weight = std::max(0.0, 1 - std::abs(u - i)) * std::max(0.0, 1 - std::abs(v - j));
            if (weight > 0) sum += weight * level.at(i, j).x;
        }
    return sum;
}

/// A pixel as an eye sees it that is adapted to the degree about it (Ward Larson et al. 1997, section 5.3): blurred
/// over sqrt(2) of the smallest period it resolves, by blending two levels. `levels`: the pyramid, of which five are
/// used.
inline dvec3 seen(dvec3 rgb, uint32_t x, uint32_t y, const std::vector<PyramidLevel>& levels, uint32_t foveal_level,
                  double pixels_per_degree) {
    const double l = luminance(rgb);
    if (!std::isfinite(l)) return rgb;
    const double adapted = std::max(luminance_at(levels[foveal_level - 1], foveal_level, x, y), kFloor);
    const double footprint = std::sqrt(2) * pixels_per_degree / vision::acuity(adapted);
    const double level =
        std::clamp(std::log2(std::max(footprint, 1.0)), 0.0, double(std::min<size_t>(levels.size(), 5)));
    const auto blurred = [&](double k) { return k == 0 ? l : luminance_at(levels[size_t(k) - 1], uint32_t(k), x, y); };
    const double below = std::floor(level), above = std::min(below + 1, double(std::min<size_t>(levels.size(), 5)));
    const double mixed = blurred(below) + (level - below) * (blurred(above) - blurred(below));
    return mixed < l ? rgb * (mixed / l) : rgb + (mixed - l);
}

}  // namespace vesper::reference
