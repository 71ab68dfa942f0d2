// Cells of a radiosity solution as the shaders read them. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "transport/radiosity.h"

namespace vesper::gpu_scene {

/// The table of shared/indirect.h.
struct IrradianceCells {
    std::vector<glm::uvec4> texels;
    uint32_t log2_places = 1;
};
/// `illuminance` of each cell, RGB lx.
IrradianceCells irradiance_cells(const transport::Radiosity& radiosity, std::span<const glm::vec3> illuminance);

}  // namespace vesper::gpu_scene
