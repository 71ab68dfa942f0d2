// Flat pieces of meshes. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "scene/scene.h"

namespace vesper::gpu_scene {

/// A triangle, or a convex quadrilateral of it and the triangle across its longest edge that lies in its plane and over
/// which colours go on. Where the surface is masked, the texture coordinates of the four corners are a linear function
/// of the place.
struct Facet {
    std::array<uint32_t, 4> corners{};  ///< vertices, counter-clockwise seen from the front, the triangle's first first
    uint32_t count = 3;                 ///< corners
    uint32_t region = 0;  ///< a number that triangles share over whose common edges colours and, of textured surfaces,
                          ///< texture coordinates go on; and those without texture that have a colour in common
};

/// For each triangle of a primitive of this material the facet that it is of. Vertices at the same place are one.
std::vector<Facet> facets(const scene::Primitive& primitive, const scene::Material& material);

}  // namespace vesper::gpu_scene
