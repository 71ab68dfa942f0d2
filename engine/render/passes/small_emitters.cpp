#include "render/passes/small_emitters.h"

#include <algorithm>

#include "shaders/small_emitters/small_emitters.comp.inc"
#include "shared/edges.h"
#include "shared/luminaire.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::update;

constexpr gpu::Shader kSmallEmitters{"small_emitters.comp", small_emitters_comp};

}  // namespace

graph::Resource add_small_emitters(const FrameContext& frame, const GBuffer& surfaces, graph::Resource luminance,
                                   const gpu_scene::SmallEmitterList& list) {
    if (list.tiles.empty()) return luminance;
    graph::FrameGraph& graph = frame.graph;
    const gpu_scene::View& view = frame.view;
    const auto tiles = uint32_t(list.tiles.size());
    const graph::Resource emitters = graph.upload("small emitters", list.emitters, VK_FORMAT_R32G32B32A32_SFLOAT);
    const graph::Resource silhouettes =
        graph.upload("silhouettes of small emitters", list.silhouettes, VK_FORMAT_R32G32_SFLOAT);
    const graph::Resource touched = graph.upload("tiles of small emitters", list.tiles, VK_FORMAT_R32G32B32A32_UINT);
    const graph::Resource entries = graph.upload("entries of small emitters", list.entries, VK_FORMAT_R32_UINT);
    graph.dispatch(
        "small emitters", frame.kernels.get(kSmallEmitters),
        {load(surfaces.triangle), load(surfaces.surface), update(luminance), sample(emitters), sample(silhouettes),
         sample(touched), sample(entries), sample(surfaces.instances), sample(surfaces.vertices),
         sample(surfaces.facets)},
        shared::SmallEmittersPush{{view.extent.width, view.extent.height}, view.ray_scale(), view.ray_offset(), tiles},
        {std::min(tiles, shared::kTilesPerRow), (tiles + shared::kTilesPerRow - 1) / shared::kTilesPerRow, 1});
    return luminance;
}

}  // namespace vesper::render
