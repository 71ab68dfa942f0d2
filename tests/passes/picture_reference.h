// Pictures of other renderers in double. SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

namespace vesper::reference {

/// Scene luminance, RGB cd/m^2 and alpha 1, of a texel.
inline glm::dvec4 add_picture(glm::dvec3 texel, double scale) { return {texel * scale, 1}; }

}  // namespace vesper::reference
