// Ends of the rays of light transport. SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "rays/ray_caster.h"

namespace vesper::transport {

/// How far before a surface its rays start, m: what touches it does not hide it, nor do its own rounded corners.
inline double skin_at(const rays::RayCaster& rays, glm::dvec3 point) {
    return 1e-4 + 4e-7 * glm::distance(point, rays.middle());
}
/// How far rays look for a surface, m; beyond is the sky.
constexpr double kReach = 1e5;

}  // namespace vesper::transport
