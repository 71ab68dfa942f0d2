#include "render/passes/edges.h"

#include <algorithm>

#include "render/pixel_groups.h"
#include "shaders/edges/edge_means.comp.inc"
#include "shaders/edges/find_edges.comp.inc"
#include "shaders/edges/show_edges.comp.inc"
#include "shared/edges.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store, graph::update;

constexpr gpu::Shader kFindEdges{"find_edges.comp", find_edges_comp},
    kEdgeMeans{"edge_means.comp", edge_means_comp, edge_means_comp_storage},
    kShowEdges{"show_edges.comp", show_edges_comp, show_edges_comp_storage};

}  // namespace

void add_edges(const FrameContext& frame, const GBuffer& surfaces, graph::Resource luminance) {
    if (surfaces.facets == graph::Resource{}) return;
    graph::FrameGraph& graph = frame.graph;
    const gpu_scene::View& view = frame.view;
    const uint64_t pixels = uint64_t(view.extent.width) * view.extent.height;
    if (pixels > frame.kernels.device().most_texels(sizeof(glm::vec4))) return;
    const graph::Resource counts =
        graph.transient("edge counts", graph::buffer_shape(shared::kEdgeCounts * sizeof(uint32_t), VK_FORMAT_R32_UINT));
    const graph::Resource edges =
        graph.transient("edges", graph::buffer_shape(pixels * sizeof(uint32_t), VK_FORMAT_R32_UINT));
    const graph::Resource means = graph.transient(
        "means at edges", graph::buffer_shape(pixels * sizeof(glm::vec4), VK_FORMAT_R32G32B32A32_SFLOAT));
    const shared::EdgesPush push{{view.extent.width, view.extent.height}, view.ray_scale(), view.ray_offset()};
    const PixelGroups groups = pixel_groups(frame.kernels.device());
    const graph::Arguments listed{counts};

    graph.copy("no edges", graph.upload("no edges yet", std::vector<uint32_t>{0, 1, 1, 0}, VK_FORMAT_R32_UINT), counts);
    graph.dispatch("find edges", frame.kernels.get(kFindEdges, {groups.width, groups.height, groups.rows}),
                   {load(surfaces.triangle), load(surfaces.surface), load(luminance), update(counts), store(edges)},
                   push, cover(view.extent, groups));
    graph.dispatch("edge means", frame.kernels.get(kEdgeMeans),
                   {load(surfaces.triangle), load(surfaces.surface), load(luminance), sample(counts), sample(edges),
                    sample(surfaces.instances), sample(surfaces.vertices), sample(surfaces.facets), store(means)},
                   push, listed);
    graph.dispatch("show edges", frame.kernels.get(kShowEdges),
                   {sample(counts), sample(edges), sample(means), update(luminance)}, push, listed);
}

}  // namespace vesper::render
