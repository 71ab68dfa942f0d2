// Luminances of targets and of what surrounds them, pixel by pixel. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "passes/pyramid_reference.h"

namespace vesper::reference {

/// A picture of targets: pixel (x, y), y down, sees along (scale (pixel + 1/2) + offset, -1).
struct TargetPicture {
    int width = 1, height = 1;
    dvec2 scale{1}, offset{0};
    std::vector<uint32_t> target;      ///< of each pixel, from 1; 0: none
    std::vector<dvec3> scene, retina;  ///< of each pixel, cd/m^2
    double brightest = HUGE_VAL;       ///< cd/m^2: a brighter pixel is a glare source
};

struct MeasuredTarget {
    int pixels = 0, inner = 0, around = 0;
    double solid_angle = 0, luminance = 0, around_scene = 0, around_retina = 0;
    dvec2 centre{0};
};

/// Target number `which`, from 1, within columns [left, right) and rows [top, bottom), of which every `stride`-th is
/// looked at.
inline MeasuredTarget measure_target(const TargetPicture& p, uint32_t which, int left, int top, int right, int bottom,
                                     int stride = 1) {
    const auto index = [&](int x, int y) { return size_t(y) * size_t(p.width) + size_t(x); };
    const auto luminance = [](dvec3 c) { return 0.212639 * c.r + 0.715169 * c.g + 0.072192 * c.b; };
    MeasuredTarget m;
    for (int y = top; y < bottom; y += stride)
        for (int x = left; x < right; x += stride) {
            const uint32_t here = p.target[index(x, y)];
            bool alike = true;
            for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}})
                if (x + dx >= 0 && x + dx < p.width && y + dy >= 0 && y + dy < p.height) {
                    const size_t beside = index(x + dx, y + dy);
                    alike &= p.target[beside] == here && !(luminance(p.scene[beside]) > p.brightest);
                }
            const double scene = luminance(p.scene[index(x, y)]), retina = luminance(p.retina[index(x, y)]);
            const bool counts = alike && std::isfinite(scene) && std::isfinite(retina) && scene <= p.brightest;
            if (here == which) {
                const dvec2 ray = p.scale * dvec2(x + 0.5, y + 0.5) + p.offset;
                ++m.pixels, m.solid_angle += stride * stride * std::pow(1 + glm::dot(ray, ray), -1.5);
                m.centre += dvec2(x + 0.5, y + 0.5);
                if (counts) ++m.inner, m.luminance += scene;
            } else if (here == 0 && counts) {
                ++m.around, m.around_scene += scene, m.around_retina += retina;
            }
        }
    const auto mean = [](auto sum, int n) { return n > 0 ? sum / double(n) : sum; };
    m.centre = mean(m.centre, m.pixels), m.luminance = mean(m.luminance, m.inner);
    m.around_scene = mean(m.around_scene, m.around), m.around_retina = mean(m.around_retina, m.around);
    return m;
}

/// Luminance above which a pixel is a glare source: a hundred times the log average (of at least 1e-4 cd/m^2 each) or
/// the mean, whichever is less, but at least 300 cd/m^2.
inline double brightest_surroundings(const std::vector<dvec3>& picture) {
    double sum = 0, logarithms = 0, n = 0;
    for (const dvec3& c : picture) {
        const double l = 0.212639 * c.r + 0.715169 * c.g + 0.072192 * c.b;
        if (!std::isfinite(l)) continue;
        sum += l, logarithms += std::log(std::max(l, 1e-4)), ++n;
    }
    return n > 0 ? std::max(300.0, 100 * std::min(sum / n, std::exp(logarithms / n))) : 300;
}

}  // namespace vesper::reference
