// Making normals of triangles. SPDX-License-Identifier: MIT
#pragma once

#include "scene/scene.h"

namespace vesper::scene {

/// Normal of a triangle times twice its area.
glm::vec3 area_normal(const std::vector<Vertex>& vertices, const uint32_t* corners);
/// A vector scaled to unit length; up if it has no direction.
glm::vec3 unit_or_up(glm::vec3 v);
/// Sets the normals of vertices marked in `missing` to the mean of the triangles around them, by area; up if that has
/// no direction.
void fill_normals(Primitive& primitive, const std::vector<char>& missing);
/// Flat shading: gives each triangle its own three vertices with its normal.
void make_flat(Primitive& primitive);

}  // namespace vesper::scene
