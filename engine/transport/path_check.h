// Light of cells against light that paths find. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "transport/radiosity.h"

namespace vesper::transport {

/// Means over surfaces of all light but that of lamps directly, lx. Places count by their area and by how much they see
/// of what is more than a metre away, and so as pictures show them.
struct PathCheck {
    uint32_t places = 0;  ///< that were looked at
    double cells = 0;     ///< light of the cells there
    double paths = 0;     ///< light that LightTracer finds
    double error = 0;     ///< standard error of ratio()

    double ratio() const { return paths > 0 ? cells / paths : 0; }
};

/// Of a scene at rest, as gather_radiosity() was given it, with its sky. At 512 places, chosen by the light that cells
/// give them; what shows them a back of a surface, as within a house, leaves them out.
PathCheck check_by_paths(const scene::Scene& scene, std::span<const glm::dmat4> world, const std::vector<bool>& moving,
                         const Radiosity& radiosity, uint32_t reflections);

}  // namespace vesper::transport
