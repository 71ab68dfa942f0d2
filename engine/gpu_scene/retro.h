// Retroreflective classes as the shaders read them. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "photometry/retroreflection.h"

namespace vesper::gpu_scene {

/// The texels of shared/retro.h; always of kRetroClasses classes, so that no index leaves the buffer.
std::vector<glm::vec4> retro_texels(std::span<const photometry::Retroreflector>);

}  // namespace vesper::gpu_scene
