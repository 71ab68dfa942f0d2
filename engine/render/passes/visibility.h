// What blocks of pixels see of lamps. SPDX-License-Identifier: MIT
#pragma once

#include "render/passes/blocks.h"
#include "shared/visibility.h"

namespace vesper::render {

/// Distance maps of the lamps of a frame (shared/distance_map.h); without `lamps` every lamp is seen from everywhere.
struct VisibilityMaps {
    graph::Resource lamps{};      ///< rgba32f, shared::kMapTexels of each lamp that has a place
    graph::Resource distances{};  ///< r16f
    graph::Resource bounds{};     ///< rg16f
};

/// Takes the lamps that nothing of a block sees off its list, and marks the entries of those that some of it may not
/// see (shared::kMixedBit). Without maps nothing changes.
Blocks add_visibility(const FrameContext& frame, const GBuffer& surfaces, const Clusters& clusters, Blocks blocks,
                      const VisibilityMaps& maps);

}  // namespace vesper::render
