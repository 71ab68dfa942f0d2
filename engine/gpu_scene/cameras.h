// Cameras of a scene as views. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view.h"

namespace vesper::gpu_scene {

/// Names of the scene's cameras, in the order of their nodes.
std::vector<std::string> camera_names(const scene::Scene& scene);

/// The view of the named camera at the poses of `frame`; with an empty name, of the first camera, or, where the scene
/// has none, one that frames the whole scene from above its front. Throws Error naming the cameras there are.
View camera_view(const scene::Scene& scene, const SceneFrame& frame, const std::string& name, VkExtent2D extent);

}  // namespace vesper::gpu_scene
