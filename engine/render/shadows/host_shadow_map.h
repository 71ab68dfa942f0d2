// The shadow map of one lamp, on the host. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "render/shadows/shadow_map_layout.h"

namespace vesper::render {

/// The shadow map of a lamp (shared/shadow_map.h) with everything in its scene but its fixture, at t = 0.
struct HostShadowMap {
    ShadowMapLayout layout;
    MapFrame frame;
    size_t fixture = 0;            ///< nodes with meshes that never hide the lamp
    std::vector<float> distances;  ///< hemisphere by hemisphere, row by row: m from the lamp to the first surface along
                                   ///< the middle of a texel; 0 where there is none within the range

    /// At u, v of the square of a hemisphere, from -1 to 1, in the world frame; of length 1 in the norm
    /// |x| + |y| + |z| of the map's frame.
    glm::dvec3 direction(glm::dvec2 uv, bool second_hemisphere) const;
};

/// Draws the map of the lamp at a node. `side` in texels: a power of two from kLeastMapSide to kMostMapSide. Throws
/// Error if the lamp has no map (directional ones, and those without intensity) or the device fails.
HostShadowMap host_shadow_map(gpu::Device& device, const scene::Scene& scene, uint32_t node, uint32_t side);

}  // namespace vesper::render
