// Flat pieces of meshes. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "scene/scene.h"

namespace vesper::gpu_scene {

/// A triangle, or a convex quadrilateral of it and the triangle across its longest edge that lies in its plane.
struct Facet {
    std::array<uint32_t, 4> corners{};  ///< vertices, counter-clockwise seen from the front, the triangle's first first
    uint32_t count = 3;                 ///< corners
};

/// For each triangle of a primitive the facet that it is of. Vertices at the same place are one.
std::vector<Facet> facets(const scene::Primitive& primitive);

}  // namespace vesper::gpu_scene
