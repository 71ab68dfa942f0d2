// Luminance of colours. SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

namespace vesper {

/// Luminance of a linear Rec. 709 colour, in the colour's unit. The weights are those of its primaries and white (SMPTE
/// RP 177); IEC 61966-2-1 prints four of their digits.
inline double luminance(glm::dvec3 rgb) { return 0.212639 * rgb.r + 0.715169 * rgb.g + 0.072192 * rgb.b; }

}  // namespace vesper
