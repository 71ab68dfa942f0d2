// Places that daylight does not reach into. SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

namespace vesper::scene {

/// Where light from everywhere comes in at the two ends only.
struct Tunnel {
    glm::vec3 from{0}, to{0};     ///< middle of the floor at either end, m
    float width = 0, height = 0;  ///< inside, m
};

}  // namespace vesper::scene
