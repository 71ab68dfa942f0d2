// Codes of pictures as linear values, and what materials reflect with them. SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "scene/scene.h"

namespace vesper {

/// The linear value of each 8-bit code: sRGB, or Eq. 1 of Petit, Bremond and Vienne.
std::array<double, 256> linear_codes(const Transfer& transfer);

/// Mean reflectance of a material's base colour (luminance), its texture through a transfer.
double mean_reflectance(const Scene& scene, const Material& material, const Transfer& transfer);

}  // namespace vesper
