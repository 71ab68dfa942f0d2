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
    static constexpr uint32_t kMasked = 1u << 31;  ///< flag of `source`: only its texture tells where it stops light
    std::array<glm::vec3, 3> corners;              ///< m, from TriangleList::origin
    uint32_t source = 0;                           ///< its number in the scene, see TriangleList::Run
};

/// Triangles, and where in the scene they come from.
struct TriangleList {
    /// Triangles of one primitive at one node: numbers `first` and following.
    struct Run {
        uint32_t first, node, primitive;
    };
    glm::dvec3 origin{0};  ///< amid the triangles, m: so that floats are near 0
    std::vector<Triangle> triangles;
    std::vector<Run> runs;  ///< ascending by `first`
    uint64_t left_out = 0;  ///< triangles without area, and those with a corner that is not finite or beyond kFarthest
};

/// From the world's origin, along any axis, m. Farther corners are errors of a file, and floats have no place for them.
constexpr double kFarthest = 1e8;
/// Limit of the numbers of triangles.
constexpr uint64_t kMostTriangles = Triangle::kMasked;

/// Triangles of the scene with nodes at `world`; those of clear materials are none. Triangles without area and those
/// out of reach are left out.
uint64_t count_triangles(const scene::Scene& scene);
/// The same; `scene` has at most kMostTriangles.
TriangleList list_triangles(const scene::Scene& scene, std::span<const glm::dmat4> world);

}  // namespace vesper::rays
