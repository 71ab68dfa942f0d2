#include "render/passes/edges.h"

#include <algorithm>
#include <string>

#include "render/pixel_groups.h"
#include "shaders/edges/edge_means.comp.inc"
#include "shaders/edges/find_edges.comp.inc"
#include "shaders/edges/find_seams.comp.inc"
#include "shaders/edges/show_edges.comp.inc"
#include "shared/edges.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store, graph::update;

constexpr gpu::Shader kFindSeams{"find_seams.comp", find_seams_comp},
    kFindEdges{"find_edges.comp", find_edges_comp, find_edges_comp_storage},
    kEdgeMeans{"edge_means.comp", edge_means_comp, edge_means_comp_storage},
    kShowEdges{"show_edges.comp", show_edges_comp, show_edges_comp_storage};

}  // namespace

void add_edges(const FrameContext& frame, const GBuffer& surfaces, graph::Resource luminance, uint32_t points) {
    if (surfaces.facets == graph::Resource{}) return;
    graph::FrameGraph& graph = frame.graph;
    const gpu_scene::View& view = frame.view;
    const uint64_t pixels = uint64_t(view.extent.width) * view.extent.height;
    if (pixels > frame.kernels.device().most_texels(sizeof(glm::vec4))) return;
    // A list of pixels, and how many there are.
    struct List {
        graph::Resource counts, pixels;
    };
    const graph::Resource none = graph.upload("no edges yet", std::vector<uint32_t>{0, 1, 1, 0}, VK_FORMAT_R32_UINT);
    const auto list_of = [&](const std::string& name) {
        const List list{graph.transient(name + " counts", graph::buffer_shape(shared::kEdgeCounts * sizeof(uint32_t),
                                                                              VK_FORMAT_R32_UINT)),
                        graph.transient(name, graph::buffer_shape(pixels * sizeof(uint32_t), VK_FORMAT_R32_UINT))};
        graph.copy("no " + name, none, list.counts);
        return list;
    };
    const List seams = list_of("seams"), edges = list_of("edges");
    const graph::Resource means = graph.transient(
        "means at edges", graph::buffer_shape(pixels * sizeof(glm::vec4), VK_FORMAT_R32G32B32A32_SFLOAT));
    const shared::EdgesPush push{{view.extent.width, view.extent.height}, view.ray_scale(), view.ray_offset()};
    const PixelGroups groups = pixel_groups(frame.kernels.device());
    const graph::Arguments at_seams{seams.counts}, at_edges{edges.counts};

    graph.dispatch("find seams", frame.kernels.get(kFindSeams, {groups.width, groups.height, groups.rows}),
                   {load(surfaces.triangle), update(seams.counts), store(seams.pixels)}, push,
                   cover(view.extent, groups));
    graph.dispatch("find edges", frame.kernels.get(kFindEdges),
                   {load(surfaces.triangle), load(surfaces.surface), load(luminance), sample(seams.counts),
                    sample(seams.pixels), sample(surfaces.facets), update(edges.counts), store(edges.pixels)},
                   push, at_seams);
    graph.dispatch("edge means", frame.kernels.get(kEdgeMeans, {points, uint32_t(frame.kernels.device().anisotropy())}),
                   {load(surfaces.triangle), load(surfaces.surface), load(luminance), sample(edges.counts),
                    sample(edges.pixels), sample(surfaces.instances), sample(surfaces.vertices),
                    sample(surfaces.facets), sample(surfaces.masks), store(means)},
                   push, at_edges);
    graph.dispatch("show edges", frame.kernels.get(kShowEdges),
                   {sample(edges.counts), sample(edges.pixels), sample(means), update(luminance)}, push, at_edges);
}

}  // namespace vesper::render
