// Mean colours of parts of the picture. SPDX-License-Identifier: MIT
#pragma once

#include "render/frame_context.h"

namespace vesper::render {

/// Means of squares of shared::kColourTile px, rgba32f: RGB, cd/m^2, and the number of finite pixels.
struct Colours {
    graph::Resource tiles;
    VkExtent2D extent{};
};

/// Without `wanted` there are none.
Colours add_colours(const FrameContext& frame, graph::Resource scene, bool wanted = true);

}  // namespace vesper::render
