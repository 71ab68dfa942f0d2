// Shadow maps, texel by texel (shared/shadow_map.h). SPDX-License-Identifier: MIT
// Octahedral maps after Meyer et al. 2010, the hemisphere as a square after Cigolle et al. 2014.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "shared/shadow_map.h"

namespace vesper::reference {

/// The point of norm |x| + |y| + |z| = 1 at a place of the square of a hemisphere; texels from its corner. Of a flat
/// map the norm is z.
inline glm::dvec3 map_direction(glm::dvec2 texel, double side, double zoom, bool flat = false) {
    const glm::dvec2 square = (texel * 2.0 / side - 1.0) / zoom;
    const double x = (square.x + square.y) / 2, y = (square.x - square.y) / 2;
    return {x, y, flat ? 1 : 1 - std::abs(x) - std::abs(y)};
}

/// Where a point with z >= 0 lies in the square, texels from its corner.
inline glm::dvec2 map_texel(glm::dvec3 p, double side, double zoom, bool flat = false) {
    const double norm = flat ? p.z : std::abs(p.x) + std::abs(p.y) + p.z;
    return (glm::dvec2(p.x + p.y, p.x - p.y) * zoom / norm + 1.0) * side / 2.0;
}

/// Texels of one hemisphere: distances, m, in the norm.
struct HemisphereMap {
    uint32_t side = 0;
    std::vector<double> norms;

    double at(int x, int y) const {
        const int last = int(side) - 1;
        return norms[size_t(std::clamp(y, 0, last)) * side + size_t(std::clamp(x, 0, last))];
    }
    /// Whether a texel and those beside it are not on one smooth surface: of inverse distances the middle one is off
    /// the mean of its neighbours by a thousandth.
    bool edge(int x, int y) const {
        const auto bent = [&](double a, double b, double c) { return std::abs(1 / a + 1 / c - 2 / b) > 2e-3 / b; };
        const int last = int(side) - 1;
        return (x > 0 && x < last && bent(at(x - 1, y), at(x, y), at(x + 1, y))) ||
               (y > 0 && y < last && bent(at(x, y - 1), at(x, y), at(x, y + 1)));
    }
};

}  // namespace vesper::reference
