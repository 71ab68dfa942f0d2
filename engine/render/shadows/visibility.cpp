#include "render/shadows/visibility.h"

#include "shaders/shadows/visibility.comp.inc"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store, graph::update;

constexpr gpu::Shader kVisibility{"visibility.comp", visibility_comp, visibility_comp_storage};

}  // namespace

Blocks add_visibility(const FrameContext& frame, const GBuffer& surfaces, const Clusters& clusters, Blocks blocks,
                      const FrameShadowMaps& maps, const VisibilitySettings& settings) {
    graph::FrameGraph& graph = frame.graph;
    if (!maps.lamps) return blocks;
    const VkExtent2D extent = frame.view.extent;
    const LampKinds kinds = lamp_kinds(clusters);
    const gpu::Kernel& kernel = frame.kernels.get(kVisibility, {kinds.powers, kinds.tables, frame.lockstep()});
    const uint32_t rows = blocks.count / blocks.columns;
    blocks.shares = graph.transient(
        "visible shares",
        graph::buffer_shape(uint64_t(blocks.count) * shared::kSharePlaces * shared::kBlockSize * sizeof(uint32_t),
                            VK_FORMAT_R32_UINT));
    graph.dispatch("visibility", kernel,
                   {load(surfaces.surface), sample(clusters.lamps), update(blocks.counts), update(blocks.entries),
                    sample(maps.lamps), sample(maps.distances), sample(clusters.tables.texels), store(blocks.shares),
                    update(blocks.visibility), load(surfaces.slope)},
                   shared::VisibilityPush{.grid = clusters.push.grid,
                                          .size = {extent.width, extent.height},
                                          .blocks_x = blocks.columns,
                                          .blocks_y = rows,
                                          .capacity = blocks.capacity,
                                          .lamps = clusters.push.lamps,
                                          .shadow_error = settings.shadow_error,
                                          .probe_error = settings.probe_error},
                   graph::Groups{blocks.columns, rows, 1});
    return blocks;
}

}  // namespace vesper::render
