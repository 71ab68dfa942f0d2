// Luminous intensity of a scene's lamps, and the luminance it gives their openings. SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "scene/scene.h"

namespace vesper {

/// Intensity of a lamp in a direction of its own frame (axis -Z, right +X, up +Y; any length), cd. A directional light
/// has none: 0.
double luminous_intensity(const Light& light, std::span<const Distribution> distributions, glm::dvec3 direction);

/// Luminance of its opening seen along its axis, L = I / A, cd/m^2; 0 without opening.
double axis_luminance(const Light& light, std::span<const Distribution> distributions);

/// A factor as people say it: "12 % more", "33 % less".
std::string deviation(double factor);

}  // namespace vesper
