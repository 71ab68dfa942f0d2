// Skies as the shaders read them. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "photometry/sky_map.h"

namespace vesper::gpu_scene {

/// The texels of shared/sky.h.
std::vector<glm::vec4> sky_texels(const photometry::SkyMap&);

}  // namespace vesper::gpu_scene
