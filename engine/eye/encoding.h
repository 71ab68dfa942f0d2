// A display as the shaders see it: from displayed light to codes. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "shared/encode.h"
#include "vision/display.h"

namespace vesper::eye {

/// Cells of displayed light and how they are found, see shared/encode.h.
struct Encoding {
    std::vector<glm::vec4> cells;  ///< texels, rgba32f
    shared::EncodePush push;
};
Encoding make_encoding(const vision::Display&);

}  // namespace vesper::eye
