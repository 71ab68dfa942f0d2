// Bodies that move and patches that moving lamps light, as the shaders see them. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view.h"
#include "shared/moving_light.h"
#include "transport/lamp_reflections.h"
#include "transport/moving_bodies.h"

namespace vesper::gpu_scene {

/// What of them a view sees, as shared/moving_light.h has it.
struct MovingThings {
    std::vector<shared::HidingBody> bodies;
    std::vector<glm::vec4> patches;  ///< texels
};
/// The kMostBodies nearest to the eye and the kMostPatches that give it most.
MovingThings moving_things(const transport::MovingBodies& bodies, std::span<const transport::LitPatch> patches,
                           const SceneFrame& poses, const View& view);

/// Texels of MovingBodies::hidden, as shared/moving_light.h has them.
std::vector<glm::uvec4> volume_texels(const transport::MovingBodies& bodies);

}  // namespace vesper::gpu_scene
