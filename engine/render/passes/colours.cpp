#include "render/passes/colours.h"

#include "shaders/colours/colours.comp.inc"
#include "shared/luminance.h"

namespace vesper::render {
namespace {

constexpr gpu::Shader kColours{"colours.comp", colours_comp};

}  // namespace

Colours add_colours(const FrameContext& frame, graph::Resource scene, bool wanted) {
    if (!wanted) return {};
    constexpr uint32_t tile = shared::kColourTile;
    const VkExtent2D extent = frame.view.extent,
                     tiles{(extent.width + tile - 1) / tile, (extent.height + tile - 1) / tile};
    const gpu::Kernel& kernel = frame.kernels.get(kColours);
    const graph::Resource colours = frame.graph.transient("colours", graph::image_shape(kSceneFormat, tiles));
    frame.graph.dispatch("colours", kernel, {graph::load(scene), graph::store(colours)},
                         shared::ColoursPush{{extent.width, extent.height}, {tiles.width, tiles.height}},
                         graph::cover(tiles.width, tiles.height, kernel.group[0], kernel.group[1]));
    return {colours, tiles};
}

}  // namespace vesper::render
