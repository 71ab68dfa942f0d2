#include <algorithm>

#include "render/passes/passes.h"

namespace vesper {

Resource add_luminaires(FrameGraph& graph, const Kernels& kernels, Resource scene, Resource surface, const LuminaireList& list,
                     const View& view) {
    if (list.tiles.empty()) return scene;
    const auto tiles = uint32_t(list.tiles.size());
    const Resource luminaires = graph.upload("sources", list.luminaires, VK_FORMAT_R32G32B32A32_SFLOAT);
    const Resource outline = graph.upload("source outlines", list.outline, VK_FORMAT_R32G32_SFLOAT);
    const Resource touched = graph.upload("source tiles", list.tiles, VK_FORMAT_R32G32B32A32_UINT);
    const Resource entries = graph.upload("source entries", list.entries, VK_FORMAT_R32_UINT);
    graph.dispatch("sources", kernels.luminaires,
                   {load(surface), update(scene), sample(luminaires), sample(outline), sample(touched), sample(entries)},
                   shared::SourcesPush{{view.extent.width, view.extent.height}, tiles},
                   {std::min(tiles, shared::kTilesPerRow), (tiles + shared::kTilesPerRow - 1) / shared::kTilesPerRow, 1});
    return scene;
}

}  // namespace vesper
