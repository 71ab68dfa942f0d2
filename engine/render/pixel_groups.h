// Workgroups of the passes over surfaces: shading, daylight and sky. SPDX-License-Identifier: MIT
#pragma once

#include "gpu/device.h"
#include "graph/frame_graph.h"

namespace vesper::render {

/// Invocations of a workgroup, and the pixels of a column that each of them shades.
struct PixelGroups {
    uint32_t width, height;  ///< invocations; the width is that of shared::kBlocksPerGroup blocks
    uint32_t rows;           ///< pixels; divides shared::kBlockSize
};

/// A CPU device works on rows of 32 and fetches a lamp once for eight pixels; a GPU on 32 x 8 pixels, one per
/// invocation.
inline PixelGroups pixel_groups(const gpu::Device& device) {
    return device.is_cpu() ? PixelGroups{32, 1, 8} : PixelGroups{32, 8, 1};
}

/// Workgroups that cover an image.
inline graph::Groups cover(VkExtent2D image, const PixelGroups& groups) {
    return graph::cover(image.width, image.height, groups.width, groups.height * groups.rows);
}

}  // namespace vesper::render
