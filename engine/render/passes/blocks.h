// Lamps of blocks of pixels: culled, and merged where their light is smooth. SPDX-License-Identifier: MIT
#pragma once

#include "render/passes/cluster.h"
#include "render/passes/gbuffer.h"
#include "shared/blocks.h"

namespace vesper::render {

/// The image in blocks of shared::kBlockSize pixels, in classes by their surfaces and lamps (shared/blocks.h).
struct Blocks {
    uint32_t columns = 0, count = 0;
    uint32_t capacity = 0;            ///< of a block's list
    graph::Resource counts, entries;  ///< lists of the lamps that its pixels evaluate one by one (shared/shade.h)
    graph::Resource sums;             ///< merged light of the other lamps
    graph::Resource class_counts, class_blocks;
    graph::Resource shares;              ///< of lamps that pixels see (shared/shade.h); none without shadow maps
    graph::Resource visibility;          ///< shared::VisibilityReport
    graph::Resource directional_shares;  ///< of directional lamps (shared/clipmap.h); none: all is seen
};

/// Lists the lamps that can light some surface of each block. Throws Error for an image of more blocks than the device
/// can shade in one dispatch.
Blocks add_blocks(const FrameContext& frame, const GBuffer& surfaces, const Clusters& clusters);

/// Where a block is one matt plane or one plane of road, merges the lamps whose light is smooth over it and takes them
/// off its list: a polynomial of second degree along either side meets it with at most the relative error `merge_error`
/// at four pixels between its nodes. At other pixels the error is 1.2 times that where light is smooth and up to 3.5
/// times at kinks (edges of a beam's ramp, cells of a table; more, in hardly a pixel, under tables with single bright
/// nodes). 0 merges nothing. Lamps that some of a block may not see (shared::kMixedBit) are not
/// merged. Puts blocks in their classes.
Blocks add_merging(const FrameContext& frame, const GBuffer& surfaces, const Clusters& clusters, Blocks blocks,
                   float merge_error);

}  // namespace vesper::render
