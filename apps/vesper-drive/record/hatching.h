// What a driver cannot see, hatched in the picture. SPDX-License-Identifier: MIT
#pragma once

#include "render/renderer.h"

namespace vesper::drive {

/// Draws stripes over the obstacles of a frame whose visibility level is known and below `visible_from`, in its codes:
/// kHatchWide px bright, as many black, and twice as many of the picture. The frame has
/// RenderSettings::obstacle_pixels; without them, and without codes, it stays as it is.
constexpr uint32_t kHatchWide = 2;
void hatch_unseen(render::Frame&, const render::RenderSettings&, double visible_from);

}  // namespace vesper::drive
