#include "render/passes/luminaires.h"

#include <algorithm>

#include "shaders/luminaires/luminaires.comp.inc"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::update;

constexpr gpu::Shader kLuminaires{"luminaires.comp", luminaires_comp};

}  // namespace

graph::Resource add_luminaires(const FrameContext& frame, graph::Resource scene, graph::Resource surface,
                               const gpu_scene::LuminaireList& list) {
    if (list.tiles.empty()) return scene;
    graph::FrameGraph& graph = frame.graph;
    const VkExtent2D image = frame.view.extent;
    const auto tiles = uint32_t(list.tiles.size());
    const graph::Resource luminaires = graph.upload("luminaires", list.luminaires, VK_FORMAT_R32G32B32A32_SFLOAT);
    const graph::Resource silhouettes =
        graph.upload("luminaire silhouettes", list.silhouettes, VK_FORMAT_R32G32_SFLOAT);
    const graph::Resource touched = graph.upload("luminaire tiles", list.tiles, VK_FORMAT_R32G32B32A32_UINT);
    const graph::Resource entries = graph.upload("luminaire entries", list.entries, VK_FORMAT_R32_UINT);
    graph.dispatch(
        "luminaires", frame.kernels.get(kLuminaires),
        {load(surface), update(scene), sample(luminaires), sample(silhouettes), sample(touched), sample(entries)},
        shared::LuminairesPush{{image.width, image.height}, tiles},
        {std::min(tiles, shared::kTilesPerRow), (tiles + shared::kTilesPerRow - 1) / shared::kTilesPerRow, 1});
    return scene;
}

}  // namespace vesper::render
