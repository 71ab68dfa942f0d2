// Triangles that have provoking vertices of their own. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "scene/scene.h"

namespace vesper::gpu_scene {

/// The triangles of a primitive, turned so that no two have the same provoking vertex, with copies of vertices where
/// there are too few. The provoking vertex is the first one, whose values a rasterizer hands on without interpolation:
/// its number tells the triangle.
class ProvokingVertices {
public:
    explicit ProvokingVertices(const scene::Primitive& primitive);

    /// For each vertex, of which of the primitive's it is a copy: those in their order, then more.
    const std::vector<uint32_t>& vertices() const { return vertices_; }
    /// Three for each triangle, in the triangles' order. Fronts remain fronts.
    const std::vector<uint32_t>& indices() const { return indices_; }

private:
    std::vector<uint32_t> vertices_, indices_;
};

}  // namespace vesper::gpu_scene
