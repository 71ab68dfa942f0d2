// The triangles of a scene that stop light, in the world. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::scene {
struct Scene;
}

namespace vesper::rays {

struct Triangle {
    std::array<glm::vec3, 3> corners;  ///< m, from TriangleList::origin
    uint32_t run, number;              ///< index into TriangleList::runs; that of the triangle in its primitive
};

/// Triangles, and where in the scene they come from.
struct TriangleList {
    /// A primitive at a node.
    struct Run {
        uint32_t node, primitive;
        bool masked;  ///< only the texture tells where its triangles stop light
    };
    glm::dvec3 origin{0};             ///< amid the triangles, m: so that floats are near 0
    std::vector<Triangle> triangles;  ///< in the order of the scene
    std::vector<Run> runs;
    uint64_t left_out = 0;  ///< triangles without area, and those with a corner that is not finite or beyond kFarthest
};

/// From the world's origin, along any axis, m. Farther corners are errors of a file, and floats have no place for them.
constexpr double kFarthest = 1e8;
/// Limit of the numbers of triangles.
constexpr uint64_t kMostTriangles = uint64_t{1} << 31u;

/// Triangles of the scene with nodes at `world`; those of clear materials are none. Triangles without area and those
/// out of reach are left out.
uint64_t count_triangles(const scene::Scene& scene);
/// The same; `scene` has at most kMostTriangles.
TriangleList list_triangles(const scene::Scene& scene, std::span<const glm::dmat4> world);

}  // namespace vesper::rays
