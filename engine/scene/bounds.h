// Boxes around parts of a scene. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>

#include <glm/glm.hpp>

namespace vesper::scene {

/// An axis-aligned box, m. Empty (low > high) until a point is added.
struct Bounds {
    glm::vec3 low{std::numeric_limits<float>::infinity()};
    glm::vec3 high{-std::numeric_limits<float>::infinity()};

    void add(glm::vec3 point) { low = glm::min(low, point), high = glm::max(high, point); }
    bool empty() const { return !(low.x <= high.x); }
};

/// The corners of a box, m, after a transform.
inline std::array<glm::dvec3, 8> placed_corners(const Bounds& box, const glm::dmat4& to_world) {
    std::array<glm::dvec3, 8> corners;
    for (int k = 0; k < 8; ++k) {
        const glm::dvec3 at(glm::mix(box.low, box.high, glm::bvec3(k & 1, k & 2, k & 4)));
        corners[size_t(k)] = glm::dvec3(to_world * glm::dvec4(at, 1));
    }
    return corners;
}

}  // namespace vesper::scene
