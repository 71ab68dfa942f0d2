// Making normals of triangles. SPDX-License-Identifier: MIT
#pragma once

#include "scene/scene.h"

namespace vesper {

/// Normal of a triangle times twice its area.
glm::vec3 area_normal(const std::vector<Vertex>& vertices, const uint32_t* corners);
/// A vector of unit length; up where it has no direction.
glm::vec3 unit_or_up(glm::vec3 v);
/// Normals of vertices whose own has no direction: of the triangles around them, by area; up where those have none. `missing`: by vertex.
void fill_normals(Primitive& primitive, const std::vector<char>& missing);
/// Flat shading: every triangle gets corners of its own, with its normal.
void make_flat(Primitive& primitive);

}  // namespace vesper
