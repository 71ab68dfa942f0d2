// The visibility of a directional lamp from a point, by its clipmap. SPDX-License-Identifier: MIT
// Percentage-closer soft shadows (Fernando 2005): the mean distance of what hides the lamp within the widest penumbra
// gives the disc that is looked at. Depths are compared with the plane of the surface (Isidoro 2006).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "passes/shadows/draw_clipmaps_reference.h"

namespace vesper::reference {

/// A lamp with its levels; distances row by row, m from the plane of the level.
struct DirectionalLamp {
    std::vector<Level> levels;
    std::vector<std::vector<double>> distances;
    double radius = 0;  ///< tangent of half its angle
};

/// Of a disc of radius 1 with 32 points: the k-th.
inline glm::dvec2 point_of_disc(int k) {
    const double golden = 2.399963 * k;
    return std::sqrt((k + 0.5) / 32) * glm::dvec2(std::cos(golden), std::sin(golden));
}

/// The share of the disc that is seen, and how many of the lookups rounding may turn.
struct DirectionalShare {
    double share = 1;
    int uncertain = 0;  ///< of 32, and more where the search for what hides the lamp is uncertain
};

/// `point` and `normal` in the world, m; `eye`: about which the levels lie.
inline DirectionalShare directional_share(const DirectionalLamp& lamp, glm::dvec3 eye, glm::dvec3 point,
                                          glm::dvec3 normal) {
    const double reach = lamp.radius * 256.0;
    const glm::dvec3 q = lamp.levels[0].rotation * (point - eye), m = lamp.levels[0].rotation * normal;
    const double wide = 1.08 * (std::max(std::abs(q.x), std::abs(q.y)) + reach);
    size_t k = 0;
    while (k + 1 < lamp.levels.size() && wide > lamp.levels[k].half_width) ++k;
    const Level& level = lamp.levels[k];
    const glm::dvec3 at = to_level(level, point);
    if (at.z > 0.8 * 6e4 || std::min(at.x, at.y) < 1 || std::max(at.x, at.y) > level.side - 1) return {};
    const double width = 2 * level.half_width / level.side;
    const glm::dvec2 slope = glm::clamp(-glm::dvec2(m) / m.z, -100.0, 100.0) * width;  // per texel
    const double bias = 1.0 / 64 + 0.5 * width + std::abs(at.z) / 1024;
    int uncertain = 0;
    const auto below = [&](glm::dvec2 offset) {
        const glm::dvec2 place = glm::dvec2(at) + offset, texel = glm::clamp(glm::floor(place), 0.0, level.side - 1);
        const double distance = lamp.distances[k][size_t(texel.y) * size_t(level.side) + size_t(texel.x)];
        const double depth = at.z + glm::dot(slope, texel + 0.5 - glm::dvec2(at)) - distance - bias;
        const glm::dvec2 edge = glm::abs(place - glm::round(place));
        uncertain += std::abs(depth) < 1e-3 || std::min(edge.x, edge.y) < 1e-3 ? 1 : 0;
        return depth;
    };
    const double most = std::max(reach / width, 0.7);  // texels
    double sum = 0;
    int hidden = 0;
    for (int i = 0; i <= 32; ++i) {  // the last one at the point itself
        const double u = (i + 0.5) / 32,
                     depth = below(i < 32 ? most * u * std::sqrt(u) * point_of_disc(i) : glm::dvec2(0));
        sum += std::max(depth, 0.0), hidden += depth > 0 ? 1 : 0;
    }
    if (uncertain > 0) uncertain = 100;  // another width
    const double radius = std::clamp(lamp.radius / width * sum / std::max(hidden, 1), 0.7, most);
    int seen = 0;
    for (int i = 0; i < 32; ++i) seen += below(radius * point_of_disc(i)) > 0 ? 0 : 1;
    return {seen / 32.0, uncertain};
}

}  // namespace vesper::reference
