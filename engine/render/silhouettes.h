// Silhouettes as the passes that draw them take them. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>

#include "gpu_scene/silhouette_tiles.h"
#include "graph/frame_graph.h"
#include "shared/luminaire.h"

namespace vesper::render {

/// A SilhouetteList as texel buffers, and a workgroup for each of its tiles.
struct SilhouetteTexels {
    graph::Resource silhouettes, tiles, entries;
    uint32_t count;  ///< of tiles
    graph::Groups groups;
};

/// `of`: what has them, for the names of the buffers. Needs at least one tile.
inline SilhouetteTexels upload(graph::FrameGraph& graph, const gpu_scene::SilhouetteList& list, const std::string& of) {
    const auto tiles = uint32_t(list.tiles.size());
    return {graph.upload(of + " silhouettes", list.silhouettes, VK_FORMAT_R32G32_SFLOAT),
            graph.upload(of + " tiles", list.tiles, VK_FORMAT_R32G32B32A32_UINT),
            graph.upload(of + " entries", list.entries, VK_FORMAT_R32_UINT),
            tiles,
            {std::min(tiles, shared::kTilesPerRow), (tiles + shared::kTilesPerRow - 1) / shared::kTilesPerRow, 1}};
}

}  // namespace vesper::render
