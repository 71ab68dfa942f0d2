// Mean colours of parts of the picture. SPDX-License-Identifier: MIT
#pragma once

#include "render/frame_context.h"

namespace vesper {

/// Means of squares of shared::kColourTile px, rgba32f: RGB, cd/m^2, and the number of finite pixels.
struct Colours {
    Resource tiles;
    VkExtent2D extent{};
};

/// Without `wanted` there are none.
Colours add_colours(const FrameContext& frame, Resource scene, bool wanted = true);

}  // namespace vesper
