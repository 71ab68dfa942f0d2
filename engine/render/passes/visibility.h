// What blocks of pixels see of lamps. SPDX-License-Identifier: MIT
#pragma once

#include "render/passes/blocks.h"
#include "shared/visibility.h"

namespace vesper::render {

/// Distance maps of the lamps of a frame (shared/distance_map.h); without `lamps` every lamp is seen from everywhere.
struct VisibilityMaps {
    graph::Resource lamps{};      ///< rgba32f, shared::kMapTexels of each lamp that has a place
    graph::Resource distances{};  ///< r16f
};

/// Takes the lamps that nothing of a block sees off its list, and tells what its pixels see of those that some of it
/// does not (shared::kMixedBit, Blocks::shares). Lamps that give no probe, of sixteen in a block, more than the share
/// `faint` of the mean light of all lamps count with the mean of what the probes see of them, unless a surface of the
/// block has a specular lobe: each is wrong by less than that share. Without maps nothing changes.
Blocks add_visibility(const FrameContext& frame, const GBuffer& surfaces, const Clusters& clusters, Blocks blocks,
                      const VisibilityMaps& maps, float faint);

}  // namespace vesper::render
