// Things of a scene that a driver should see. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/bounds.h"

namespace vesper::scene {

struct Scene;

/// A named node with surfaces at or below it.
struct Obstacle {
    /// A node with a mesh, and what the mesh fills in the node's frame.
    struct Part {
        uint32_t node;
        Bounds bounds;
    };
    std::string name;         ///< of its node; the second of one name has #2 behind it, and so on
    std::vector<Part> parts;  ///< a mesh belongs to the nearest obstacle at or above it
};

constexpr size_t kMostObstacles = 64;

/// The nodes that match patterns (matches_node), in their order. Nodes whose meshes all belong to obstacles below them
/// are none. Throws Error for a pattern without a match that has surfaces, naming the pattern after `place`, and for
/// more than kMostObstacles.
std::vector<Obstacle> find_obstacles(const Scene&, const std::vector<std::string>& patterns, const std::string& place);

}  // namespace vesper::scene
