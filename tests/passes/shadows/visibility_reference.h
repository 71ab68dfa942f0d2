// Whether a lamp sees a surface, by its shadow map. SPDX-License-Identifier: MIT
// Depths are compared along the middle of each texel with the plane of the surface (receiver plane depth bias, Isidoro
// 2006); of the four nearest texels at least half the bilinear weight decides.
#pragma once

#include "passes/shadows/draw_shadow_maps_reference.h"

namespace vesper::reference {

/// Whether a point is seen, and whether rounding may turn that.
struct MapLookup {
    bool seen = true;
    bool certain = true;
};

/// `point` and `normal` in the frame of the map, m, z >= 0 for the first hemisphere. Points outside of it are seen.
inline MapLookup lookup(const HemisphereMap& map, double zoom, glm::dvec3 point, glm::dvec3 normal, bool flat = false) {
    const double norm = flat ? std::abs(point.z) : std::abs(point.x) + std::abs(point.y) + std::abs(point.z);
    const glm::dvec2 at = map_texel(point, map.side, zoom, flat);
    if (point.z < 0 || at.x < 0 || at.y < 0 || at.x > map.side || at.y > map.side) return {};
    // 16 mm; and of the distance half a texel, and a thousandth for the rounding of halves.
    const double bias = 1.0 / 64 + norm * (1 / (map.side * zoom) + 1.0 / 1024);
    const glm::dvec2 corner = glm::floor(at - 0.5), share = at - 0.5 - corner;
    double weight = 0;
    bool certain = true;
    for (int k = 0; k < 4; ++k) {
        const glm::dvec2 texel = glm::clamp(corner + glm::dvec2(k % 2, k / 2), glm::dvec2(0), glm::dvec2(map.side - 1));
        // The plane continues as in the point's own quadrant.
        const glm::dvec2 square = ((texel + 0.5) * 2.0 / double(map.side) - 1.0) / zoom;
        const double x = (square.x + square.y) / 2, y = (square.x - square.y) / 2;
        const glm::dvec3 way(x, y, flat ? 1 : 1 - (point.x < 0 ? -x : x) - (point.y < 0 ? -y : y));
        const double away = glm::dot(normal, point);
        const double inverse = std::abs(away) > 1e-4 * norm ? glm::dot(normal, way) / away : 1 / norm;
        const double plane = 1 / std::clamp(inverse, 0.5 / norm, 2 / norm);
        const double seen = map.at(int(texel.x), int(texel.y)) + bias;
        certain = certain && std::abs(seen - plane) > 1e-4 * plane;
        weight += seen >= plane ? (k % 2 ? share.x : 1 - share.x) * (k / 2 ? share.y : 1 - share.y) : 0;
    }
    return {weight >= 0.5, certain && std::abs(weight - 0.5) > 1e-3 &&
                               std::abs(std::abs(glm::dot(normal, point)) - 1e-4 * norm) > 1e-6 * norm};
}

}  // namespace vesper::reference
