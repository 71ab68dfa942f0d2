// Saliency: how much places of a picture draw the eye. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "render/frame_context.h"

namespace vesper::render {

/// Two levels that are compared, texels of 2^k px.
struct SaliencyPair {
    uint32_t centre, surround;
};
/// The six of Itti, Koch and Niebur 1998, as far as the shorter side of a picture has a whole texel of the surround:
/// all from 256 px on, none below 32 px.
std::vector<SaliencyPair> saliency_pairs(VkExtent2D extent);

struct Saliency {
    graph::Resource map;  ///< rgba32f: saliency, conspicuity of intensity, colour and orientation, each 0 to 1
    VkExtent2D extent;    ///< texels of 16 x 16 px
};

/// Saliency of `scene` (rgba32f, cd/m^2 RGB) after Itti, Koch and Niebur 1998, with differences relative to the
/// surround after Petit, Bremond and Tarel 2009 (their principle; how colour and orientation are compared is of this
/// program): factors on luminance change nothing, as far as it is well above shared::kDarkLight. Negative channels
/// count as 0, pixels that are not finite do not count. No map where there are no pairs of levels.
Saliency add_saliency(const FrameContext& frame, graph::Resource scene);

}  // namespace vesper::render
