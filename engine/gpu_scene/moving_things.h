// Bodies that move and patches that moving lamps light, as the shaders see them. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view.h"
#include "transport/lamp_reflections.h"
#include "transport/moving_bodies.h"

namespace vesper::gpu_scene {

/// The texels of shared/moving_light.h.
struct MovingThings {
    std::vector<glm::vec4> texels;
    uint32_t bodies = 0, patches = 0;
};
/// Of what a view may show changed, the kMostBodies nearest and the kMostPatches that give the eye's surroundings most.
MovingThings moving_things(const transport::MovingBodies& bodies, std::span<const transport::LitPatch> patches,
                           const SceneFrame& poses, const View& view);

/// MovingBodies::hidden as texels of rg32ui.
std::vector<glm::uvec2> volume_texels(const transport::MovingBodies& bodies);

}  // namespace vesper::gpu_scene
