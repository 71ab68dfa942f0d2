// The visibility of lamps from blocks of pixels. SPDX-License-Identifier: MIT
#pragma once

#include "render/passes/blocks.h"
#include "shared/visibility.h"

namespace vesper::render {

/// Shadow maps of the lamps of a frame (shared/shadow_map.h); without `lamps` every lamp is seen from everywhere.
struct FrameShadowMaps {
    graph::Resource lamps{};      ///< rgba32f, shared::kShadowMapTexels of each lamp that has a place
    graph::Resource distances{};  ///< r16f
};

/// Shares of the mean light of a block.
struct VisibilitySettings {
    float shadow_error = 0, probe_error = 0;
};

/// Takes lamps that no pixel of a block sees off its list, and gives the shares that its pixels see of lamps that some
/// of them do not (shared::kMixedBit, Blocks::shares). Sixteen pixels of a block, the probes, speak for all where lamps
/// give them at most the share `shadow_error` of the mean light of all lamps: these count with the mean share that the
/// probes see, and each is wrong by less than that share of the light. Where more than shared::kSharePlaces lamps give
/// more, the share is twice as large, and so on. On surfaces with a specular lobe and on roads a lamp is taken to give
/// eight times its light; a narrow highlight that is brighter is right on average over the block. Where the probes
/// agree they speak for all of a plane, and for all of any block of lamps that give at most the share `probe_error`.
/// Without maps nothing changes.
Blocks add_visibility(const FrameContext& frame, const GBuffer& surfaces, const Clusters& clusters, Blocks blocks,
                      const FrameShadowMaps& maps, const VisibilitySettings& settings);

}  // namespace vesper::render
