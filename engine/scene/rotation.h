// Rotations and transforms of nodes, checked as readers do. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace vesper::scene {

struct Scene;

/// The rotation that these numbers stand for, whatever their length; nothing where they have none.
std::optional<glm::quat> unit_rotation(glm::vec4 xyzw);

/// A rotation rounded so that unit_rotation() gives it back to the bit.
glm::quat settled_rotation(const glm::dquat& rotation);

/// Finite numbers may still multiply to infinity along a branch of the tree: throws Error naming the scene and the
/// node.
void check_transforms(const Scene&, const std::string& name);

}  // namespace vesper::scene
