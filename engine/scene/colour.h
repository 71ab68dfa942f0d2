// Colour of light. SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "base/luminance.h"

namespace vesper::scene {

/// Linear Rec. 709 colour of luminance 1 of a black body, gamut-clipped to non-negative. `kelvin` in [1000, 25000].
glm::vec3 colour_of_temperature(double kelvin);

/// Chromaticity x, y (CIE 1931) of a linear Rec. 709 colour; (0, 0) of black.
glm::dvec2 chromaticity(glm::dvec3 rgb);

/// Correlated colour temperature, K (McCamy 1992), of a colour within 0.02 in x, y of a black body's, 1000 to 25000 K;
/// otherwise 0.
double temperature_of(glm::dvec3 rgb);

}  // namespace vesper::scene
