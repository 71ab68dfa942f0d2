// Boxes around parts of a scene. SPDX-License-Identifier: MIT
#pragma once

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

}  // namespace vesper::scene
