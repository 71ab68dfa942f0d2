// What the pixels of a projector show of a rendered picture. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <vulkan/vulkan_core.h>

#include "shared/projection.h"
#include "vision/blend_mask.h"
#include "vision/warp_mesh.h"

namespace vesper::eye {

/// A projector's picture as the shader sees it.
struct Projection {
    VkExtent2D picture{};                        ///< px, of the rendered picture
    VkExtent2D extent{};                         ///< px, of the projector's
    std::vector<shared::ProjectedPixel> pixels;  ///< of the projector's picture, row by row from the top
};

constexpr uint32_t kMaxProjectionSide = 16384;  ///< px, of either picture
constexpr float kNotDrawn = -1;                 ///< factor of pixels that no cell of the mesh covers

/// The map of a projector: for the middle of each of its pixels the place in the rendered picture, and the mesh's
/// intensity there times the mask's factor. A cell of the mesh is two triangles, on either side of the diagonal from
/// its first node to that of the next column and row; within them place and intensity are linear. Cells with a node
/// that is not drawn are left out; of cells that overlap the last counts. Without a mesh the picture fills that of the
/// projector. Throws Error if the mask has another size than the projector's picture, if an extent is 0 or more than
/// kMaxProjectionSide, and for a mesh whose cells lie on one another more than 64 times.
Projection projection_of(VkExtent2D picture, VkExtent2D projector, const vision::WarpMesh* mesh = nullptr,
                         const vision::BlendMask* mask = nullptr);

}  // namespace vesper::eye
