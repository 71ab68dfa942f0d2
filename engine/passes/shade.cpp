#include <algorithm>
#include <cmath>
#include <numeric>

#include "passes/passes.h"

namespace vesper {
namespace {

// A stride through `blocks` that visits each once and keeps neighbours in time far apart: near the golden section.
uint32_t scatter_step(uint32_t blocks) {
    uint32_t step = std::max(1u, uint32_t(blocks * 0.618));
    while (std::gcd(step, blocks) != 1) ++step;
    return step;
}

}  // namespace

Resource add_shading(FrameGraph& graph, const Kernels& kernels, const GBuffer& g, const Clusters& clusters, const View& view, const ShadeSettings& settings) {
    const Resource scene = graph.transient("scene", image_shape(kSceneFormat, view.extent));
    const Kernel& kernel = settings.all_lights ? kernels.shade_every_light : kernels.shade;
    const Groups grid = cover(view.extent.width, view.extent.height, kernels.shade_group.width, kernels.shade_group.height * kernels.shade_rows);
    const uint32_t blocks = grid.x * grid.y;
    const shared::ShadePush push{.size = {view.extent.width, view.extent.height},
                                 .grid = clusters.push.grid,
                                 .lights = clusters.push.lights,
                                 .threshold = clusters.push.threshold,
                                 .lambert = settings.lambert,
                                 .emission_limit = settings.emission_limit,
                                 .ambient = settings.ambient,
                                 .sky = settings.sky,
                                 .blocks_x = grid.x,
                                 .blocks = blocks,
                                 .block_step = scatter_step(blocks)};
    graph.dispatch("shade", kernel,
                   {load(g.reflectance), load(g.surface), load(g.emission), sample(clusters.lights), sample(clusters.counts), sample(clusters.indices), store(scene)},
                   push, {blocks, 1, 1});
    return scene;
}

}  // namespace vesper
