#include "render/passes/small_emitters.h"

#include "render/silhouettes.h"
#include "shaders/small_emitters/small_emitters.comp.inc"
#include "shared/edges.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::update;

constexpr gpu::Shader kSmallEmitters{"small_emitters.comp", small_emitters_comp, small_emitters_comp_storage};

}  // namespace

graph::Resource add_small_emitters(const FrameContext& frame, const GBuffer& surfaces, graph::Resource luminance,
                                   const gpu_scene::SmallEmitterList& list) {
    if (list.tiles.empty()) return luminance;
    graph::FrameGraph& graph = frame.graph;
    const gpu_scene::View& view = frame.view;
    const graph::Resource emitters = graph.upload("small emitters", list.emitters, VK_FORMAT_R32G32B32A32_SFLOAT);
    const SilhouetteTexels in_image = upload(graph, list, "small emitter");
    graph.dispatch("small emitters", frame.kernels.get(kSmallEmitters),
                   {load(surfaces.triangle), load(surfaces.surface), update(luminance), sample(emitters),
                    sample(in_image.silhouettes), sample(in_image.tiles), sample(in_image.entries),
                    sample(surfaces.instances), sample(surfaces.vertices), sample(surfaces.facets)},
                   shared::SmallEmittersPush{
                       {view.extent.width, view.extent.height}, view.ray_scale(), view.ray_offset(), in_image.count},
                   in_image.groups);
    return luminance;
}

}  // namespace vesper::render
