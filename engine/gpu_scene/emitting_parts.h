// Parts of a scene that emit, as small emitters are drawn. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::scene {
struct Scene;
}

namespace vesper::gpu_scene {

/// Parts of more triangles, or with more facets near them, are drawn as other surfaces are, and so are those of meshes
/// of which so many triangles would have to be looked at.
constexpr size_t kMostTrianglesOfSmallEmitter = 128, kMostFacetsOfFrame = 512, kMostLooksOfMesh = 20'000'000;

/// The triangles of a part that emits.
struct EmittingPart {
    struct Triangle {
        std::array<glm::vec3, 3> corners;  ///< m, mesh frame, counter-clockwise seen from the front
        /// RGB cd/m^2, the means over its quarters: at each corner, and in the middle.
        std::array<glm::vec3, 4> luminance;
    };
    std::vector<Triangle> triangles;  ///< none: it emits nothing, has holes, has too many, or emits to both sides and
                                      ///< is not flat or has a front on both, so that one may hide the other
    bool double_sided = false;
    bool plain = true;  ///< luminance is the same all over each triangle
    float reach = 0;    ///< m, mesh frame: what is so near to its box is listed
    /// Facets of its mesh that may hide it, of three or four corners: bars of its frame, seen from their front.
    std::vector<std::vector<glm::vec3>> frame;
};

/// Of each GpuScene::parts().
std::vector<EmittingPart> emitting_parts(const scene::Scene& scene);

/// Of a triangle: at each corner, and in the middle.
template <class Point>
std::array<std::array<Point, 3>, 4> quarters(const std::array<Point, 3>& t) {
    const Point ab = (t[0] + t[1]) / 2.0, bc = (t[1] + t[2]) / 2.0, ca = (t[2] + t[0]) / 2.0;
    return {{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {bc, ca, ab}}};
}

}  // namespace vesper::gpu_scene
