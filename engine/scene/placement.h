// Nodes put elsewhere than their scene has them. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <vector>

#include "scene/scene.h"

namespace vesper::scene {

/// Node frame to that of its parent, at rest.
glm::dmat4 local_transform(const Node&);

/// world_transforms() with some nodes, and what hangs on them, put somewhere: node frame to world, by node.
std::vector<glm::dmat4> placed_transforms(const Scene&, double seconds, const std::map<uint32_t, glm::mat4>& places);

/// Nodes at and below those given, per node.
std::vector<bool> at_and_below(const Scene&, std::vector<bool> nodes);
/// Nodes that the scene's animations move, per node.
std::vector<bool> animated_nodes(const Scene&);

}  // namespace vesper::scene
