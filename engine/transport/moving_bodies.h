// What bodies that move hide of the light around them. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "transport/cell_grid.h"

namespace vesper::scene {
struct Scene;
}

namespace vesper::transport {

/// The space around a body in places at equal steps, in the frame of its topmost node.
struct OcclusionVolume {
    glm::dvec3 low{0};    ///< the first place
    double step = 0;      ///< m, as long as no node above is scaled
    glm::uvec3 count{0};  ///< along each axis; x first
    uint32_t first = 0;   ///< index of its places in MovingBodies::hidden

    uint32_t places() const { return count.x * count.y * count.z; }
};

/// Bodies that move, with what each hides (ambient occlusion fields: Kontkanen and Laine 2005, Malmer et al. 2007).
/// Bodies count as rigid and black. Equal ones share a volume.
struct MovingBodies {
    /// A node that moves, below none that does or with animations of its own, and all that is below it but for other
    /// bodies.
    struct Body {
        uint32_t node, volume;
    };
    std::vector<Body> bodies;  ///< ascending by node
    std::vector<OcclusionVolume> volumes;
    /// Of each place, for a surface there that faces each side (+x, -x, +y, -y, +z, -z), the part of the light of a
    /// uniform hemisphere that the body hides, in parts of kAll; 0 at the border of the volume.
    /// A surface takes it linearly between the eight places around a point one step before it, of its sides by the
    /// squares of the normal's components: so far off, a body does not hide light of its own outer surfaces.
    static constexpr uint32_t kAll = 31;
    std::vector<std::array<uint8_t, kSides>> hidden;
};

/// Of a scene in which nodes are `moving` (per node; empty: none). Bodies smaller than 0.3 m across hide nothing, nor
/// do any but the kMostShapes largest shapes.
MovingBodies moving_bodies(const scene::Scene& scene, const std::vector<bool>& moving);
constexpr size_t kMostShapes = 64;

}  // namespace vesper::transport
