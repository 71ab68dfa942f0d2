// Whether a lamp sees a surface, by its shadow map. SPDX-License-Identifier: MIT
// Depths are compared along the middle of each texel with the plane of the surface (receiver plane depth bias, Isidoro
// 2006). An edge is where half the bilinear weight of the four nearest texels sees the lamp, and a pixel has a share by
// how far, in pixels, it is from there.
#pragma once

#include "passes/shadows/draw_shadow_maps_reference.h"

namespace vesper::reference {

/// The share of a pixel that is seen, 0 to 1, and whether rounding may turn what texels see.
struct MapLookup {
    double share = 1;
    bool certain = true;
};

/// `point` and `normal` in the frame of the map, m, z >= 0 for the first hemisphere. Points outside of it are seen.
/// `right`, `down`: from the point to those of the surface at the next pixels, m.
inline MapLookup lookup(const HemisphereMap& map, double zoom, glm::dvec3 point, glm::dvec3 normal, bool flat = false,
                        glm::dvec3 right = glm::dvec3(0), glm::dvec3 down = glm::dvec3(0)) {
    const double norm = flat ? std::abs(point.z) : std::abs(point.x) + std::abs(point.y) + std::abs(point.z);
    const glm::dvec2 at = map_texel(point, map.side, zoom, flat);
    if (point.z < 0 || at.x < 0 || at.y < 0 || at.x > map.side || at.y > map.side) return {};
    // 16 mm; and of the distance half a texel, and a thousandth for the rounding of halves.
    const double bias = 1.0 / 64 + norm * (1 / (map.side * zoom) + 1.0 / 1024);
    const glm::dvec2 corner = glm::floor(at - 0.5), share = at - 0.5 - corner;
    double weight = 0;
    glm::dvec2 slope(0);  // of it, by texels
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
        if (seen < plane) continue;
        const glm::dvec2 linear(k % 2 ? share.x : 1 - share.x, k / 2 ? share.y : 1 - share.y);
        weight += linear.x * linear.y;
        slope += glm::dvec2(k % 2 ? linear.y : -linear.y, k / 2 ? linear.x : -linear.x);
    }
    constexpr double kStep = 1e-5;  // px
    const auto texels = [&](glm::dvec3 step) {
        return (map_texel(point + kStep * step, map.side, zoom, flat) - map_texel(point, map.side, zoom, flat)) / kStep;
    };
    const double width = std::hypot(glm::dot(slope, texels(right)), glm::dot(slope, texels(down)));
    return {std::clamp(0.5 + (weight - 0.5) / std::clamp(width, 1e-3, 1.0), 0.0, 1.0),
            certain && std::abs(weight - 0.5) > 1e-3 &&
                std::abs(std::abs(glm::dot(normal, point)) - 1e-4 * norm) > 1e-6 * norm};
}

}  // namespace vesper::reference
