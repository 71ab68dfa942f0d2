// The grid that a rasterizer snaps vertices to. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "gpu/device.h"

namespace vesper::test {

/// Its step, px: 1/256 on most devices, and 1/16 on those with the least precision that Vulkan allows. What is seen is
/// moved by as much, along edges and on steep surfaces.
inline double snapped(const gpu::Device& device) {
    return std::ldexp(1.0, -int(device.limits().subPixelPrecisionBits));
}

/// Whether the grid is that coarse. SwiftShader, which has such a grid, also clips with its step: triangles of
/// kilometres that reach behind the eye are lost.
inline bool snaps_coarsely(const gpu::Device& device) { return snapped(device) > 1.0 / 256; }

}  // namespace vesper::test
