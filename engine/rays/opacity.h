// Where masked materials stop light. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "scene/scene.h"

namespace vesper::rays {

/// Opacity of a primitive's triangle, [0, 1]: that of material, corners and texture, as in pictures at close view
/// (between texels linear, unless the texture says nearest). `triangle` < indices.size() / 3, `weights` of its corners.
/// 1 where the texture's place is not finite.
double opacity_at(const scene::Scene& scene, const scene::Primitive& primitive, uint32_t triangle, glm::dvec3 weights);

/// Whether light that meets the triangle there stops: at the material's cutoff or above, which is exact to half a step
/// of half floats, as on the device.
bool stops_light(const scene::Scene& scene, const scene::Primitive& primitive, uint32_t triangle, glm::dvec3 weights);

/// Whether light may pass each material of a scene somewhere: of masked ones, where the least opacity of texture and
/// corners is below the cutoff.
std::vector<bool> have_holes(const scene::Scene& scene);

}  // namespace vesper::rays
