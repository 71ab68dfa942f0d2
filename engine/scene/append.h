// Scenes within scenes. SPDX-License-Identifier: MIT
#pragma once

#include "scene/scene.h"

namespace vesper::scene {

/// Puts copies of a model into a scene: its surfaces and lamps once, its nodes as often as they are asked for. Light of
/// the sky, animations and cameras of the model stay behind.
class SceneInsert {
public:
    /// Throws Error where both read the codes of their textures in different ways, or the scene would have too many
    /// retroreflectors.
    SceneInsert(Scene& to, Scene model);

    /// A node of that name, the last but those of the model below it. Returns its index. Throws Error beyond the task's
    /// Budget.
    uint32_t add(Scene& to, const std::string& name) const;

private:
    std::vector<Node> nodes_;  // with indices of the scene, parents as of the model
};

}  // namespace vesper::scene
