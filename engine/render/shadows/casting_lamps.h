// Lamps whose shadows a frame draws, by their share of its light. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "render/passes/blocks.h"
#include "shared/shadow_map.h"

namespace vesper::render {

/// A frame's lists of lamps, and the surfaces that they light.
struct BlockLists {
    const GBuffer& surfaces;
    const Clusters& clusters;
    const Blocks& blocks;  ///< whose report counts the lamps that are left out
};

/// Takes the maps from the faintest of the lamps `optional` (numbers, ascending), as many as together give at most the
/// share `most_share` of the picture's light: nothing hides these, and the picture as it were if nothing hid any lamp
/// is off by at most that share in the mean. The share of a lamp is the mean, over the middle pixels of blocks, of its
/// illuminance over that of all lamps of the block, as if nothing hid them: of all blocks in pictures of up to 16,384,
/// of every fourth in larger ones. Where a block looks at every lamp (shade.h) all keep theirs. `maps`: of the lamps of
/// the list; `most_lamps`: of any frame of the scene, so that all have buffers of one size. Returns the maps, rgba32f.
graph::Resource add_casting_lamps(const FrameContext& frame, const BlockLists& lists,
                                  const std::vector<shared::ShadowMap>& maps, std::vector<uint32_t> optional,
                                  float most_share, size_t most_lamps);

}  // namespace vesper::render
