// Luminance of colours. SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

namespace vesper {

/// Luminance of a linear Rec. 709 colour, in the colour's unit.
inline double luminance(glm::dvec3 rgb) { return 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b; }

}  // namespace vesper
