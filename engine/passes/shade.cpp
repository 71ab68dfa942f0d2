#include "passes/passes.h"

namespace vesper {
namespace {

constexpr uint32_t kBlockCapacity = 256;  // lights of a block of pixels; more, and it looks at every light

}  // namespace

Resource add_shading(FrameGraph& graph, const Kernels& kernels, const GBuffer& g, const Clusters& clusters, const View& view, const ShadeSettings& settings) {
    const Groups block_grid = cover(view.extent.width, view.extent.height, shared::kBlockSize, shared::kBlockSize);
    const uint32_t blocks = block_grid.x * block_grid.y;
    const Groups group_grid = cover(view.extent.width, view.extent.height, kernels.shade_group.width, kernels.shade_group.height * kernels.shade_rows);
    const uint32_t group_rows = (group_grid.y + kernels.shade_bands - 1) / kernels.shade_bands * kernels.shade_bands;
    const glm::uvec2 pixels{view.extent.width, view.extent.height};
    constexpr uint64_t kWord = sizeof(uint32_t);

    const Resource counts = graph.transient("block counts", buffer_shape(blocks * 2 * kWord, VK_FORMAT_R32_UINT));
    const Resource entries = graph.transient("block entries", buffer_shape(blocks * kBlockCapacity * kWord, VK_FORMAT_R32_UINT));
    uint32_t variant = 0;
    if (settings.all_lights) variant |= Kernels::kEveryLight;
    if (clusters.push.lights.powers) variant |= Kernels::kPowers;
    if (clusters.push.lights.maps) variant |= Kernels::kMaps;
    if (clusters.maps.has_roads) variant |= Kernels::kRoads;
    if (settings.retro) variant |= Kernels::kRetro;
    const Resource retro = settings.retro ? settings.retro : clusters.maps.texels;  // the binding must hold something
    const Kernel& select = kernels.select(variant);
    graph.dispatch("select", select,
                   {load(g.surface), sample(clusters.lights), sample(clusters.counts), sample(clusters.indices), store(counts), store(entries), sample(clusters.maps.texels)},
                   shared::SelectPush{clusters.push, pixels, block_grid.x, kBlockCapacity},
                   cover(block_grid.x, block_grid.y, select.group[0], select.group[1]));

    const shared::ShadePush push{.size = pixels,
                                 .grid = clusters.push.grid,
                                 .lights = clusters.push.lights,
                                 .threshold = clusters.push.threshold,
                                 .lambert = settings.lambert,
                                 .emission_limit = settings.emission_limit,
                                 .ambient = settings.ambient,
                                 .sky = settings.sky,
                                 .blocks_x = block_grid.x,
                                 .capacity = kBlockCapacity,
                                 .roads = clusters.maps.roads,
                                 .group_rows = group_rows,
                                 .bands = kernels.shade_bands};
    graph.dispatch("shade", kernels.shade(variant),
                   {load(g.reflectance), load(g.surface), update(g.emission), sample(clusters.lights), sample(counts), sample(entries), sample(clusters.maps.texels), sample(retro)},
                   push, {group_grid.x, group_rows, 1});
    return g.emission;
}

}  // namespace vesper
