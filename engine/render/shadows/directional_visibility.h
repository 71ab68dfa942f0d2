// The visibility of directional lamps from pixels. SPDX-License-Identifier: MIT
#pragma once

#include "render/passes/blocks.h"
#include "render/passes/gbuffer.h"
#include "shared/clipmap.h"

namespace vesper::render {

/// Clipmaps of the directional lamps of a frame (shared/clipmap.h); without `lamps` they are seen from everywhere.
struct FrameClipmaps {
    graph::Resource lamps{};      ///< rgba32f, shared::kClipmapTexels of each
    graph::Resource distances{};  ///< r16f
    uint32_t levels = 0, side = 0;
};

/// Gives the share of each directional lamp, a disc in the sky, that each pixel sees (Blocks::directional_shares): by
/// 32 lookups within the penumbra of its casters, in 255ths. Penumbrae are those of casters at most
/// shared::kPenumbraReach away, at their mean distance; edges of shadows are within a texel of a level, which is 0.1 to
/// 0.2 % of the distance from the eye. Beyond the last level nothing hides a lamp. Without maps nothing changes.
Blocks add_directional_visibility(const FrameContext& frame, const GBuffer& surfaces, const Clusters& clusters,
                                  Blocks blocks, const FrameClipmaps& maps);

}  // namespace vesper::render
