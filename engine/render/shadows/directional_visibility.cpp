#include "render/shadows/directional_visibility.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "shaders/shadows/directional_visibility.comp.inc"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store;

constexpr gpu::Shader kDirectionalVisibility{"directional_visibility.comp", directional_visibility_comp,
                                             directional_visibility_comp_storage};

}  // namespace

Blocks add_directional_visibility(const FrameContext& frame, const GBuffer& surfaces, const Clusters& clusters,
                                  Blocks blocks, const FrameClipmaps& maps) {
    if (!maps.lamps) return blocks;
    const uint32_t lamps = clusters.push.lamps.directional;
    const uint64_t words = (lamps + shared::kSharesPerWord - 1) / shared::kSharesPerWord;
    const uint64_t elements = blocks.count * words * shared::kBlockSize * shared::kBlockSize;
    const VkExtent2D extent = frame.view.extent;
    const gpu::Device& device = frame.kernels.device();
    const uint64_t written = device.limits().maxStorageBufferRange / sizeof(uint32_t);
    if (elements > std::min(device.most_texels(sizeof(uint32_t)), written))
        throw Error("an image of " + std::to_string(extent.width) + " x " + std::to_string(extent.height) + " with " +
                    std::to_string(lamps) +
                    " directional lights has more shares than the device can hold; without shadows it can be rendered");
    blocks.directional_shares = frame.graph.transient(
        "directional shares", graph::buffer_shape(elements * sizeof(uint32_t), VK_FORMAT_R32_UINT));
    frame.graph.dispatch(
        "directional visibility", frame.kernels.get(kDirectionalVisibility, {frame.lockstep()}),
        {load(surfaces.surface), sample(maps.lamps), sample(maps.distances), store(blocks.directional_shares)},
        shared::DirectionalVisibilityPush{.grid = clusters.push.grid,
                                          .size = {extent.width, extent.height},
                                          .blocks_x = blocks.columns,
                                          .lamps = lamps,
                                          .levels = maps.levels,
                                          .side = maps.side},
        graph::Groups{blocks.columns, blocks.count / blocks.columns, 1});
    return blocks;
}

}  // namespace vesper::render
