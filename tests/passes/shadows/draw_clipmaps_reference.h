// Maps of directional lamps, texel by texel (shared/clipmap.h). SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "shared/clipmap.h"

namespace vesper::reference {

/// A level: rows of `rotation` are the axes of the map in the world, z the way of the light; `middle` is in these axes,
/// m.
struct Level {
    glm::dmat3 rotation{1};
    glm::dvec3 middle{0};
    double half_width = 0;  ///< m
    double side = 0;        ///< texels
};

/// Where the plane of a level is at a place of its square, texels from its corner; world, m.
inline glm::dvec3 on_level(const Level& level, glm::dvec2 texel) {
    const glm::dvec2 across = (texel / level.side * 2.0 - 1.0) * level.half_width;
    return glm::transpose(level.rotation) * (level.middle + glm::dvec3(across, 0));
}

/// Where a point of the world lies in the square, texels, and along the light, m from the plane of the level.
inline glm::dvec3 to_level(const Level& level, glm::dvec3 point) {
    const glm::dvec3 from = level.rotation * point - level.middle;
    return {(glm::dvec2(from) / level.half_width + 1.0) * 0.5 * level.side, from.z};
}

}  // namespace vesper::reference
