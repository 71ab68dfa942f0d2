#include <algorithm>
#include <cmath>
#include <string>

#include "render/passes/passes.h"
#include "shared/photometry.h"

namespace vesper {

Pyramid add_pyramid(FrameGraph& graph, const Kernels& kernels, Resource scene, VkExtent2D extent, float log_epsilon) {
    Pyramid pyramid;
    Resource from = scene;
    do {
        const VkExtent2D half{(extent.width + 1) / 2, (extent.height + 1) / 2};
        const std::string name = "luminance " + std::to_string(pyramid.levels.size() + 1);
        const Resource to = graph.transient(name, image_shape(kSceneFormat, half));
        const Kernel& kernel = pyramid.levels.empty() ? kernels.pyramid_first : kernels.pyramid;
        graph.dispatch(name, kernel, {load(from), store(to)},
                       shared::PyramidPush{{extent.width, extent.height}, {half.width, half.height}, log_epsilon > 0 ? 0 : shared::kLuminanceFloor, log_epsilon, 0},
                       cover(half.width, half.height, kernel.group[0], kernel.group[1]));
        pyramid.levels.push_back(to);
        pyramid.extents.push_back(half);
        from = to;
        extent = half;
    } while (extent.width > 1 || extent.height > 1);
    return pyramid;
}

uint32_t foveal_level(const View& view, const Pyramid& pyramid) {
    const double level = std::round(std::log2(1 / view.degrees_per_pixel()));
    return uint32_t(std::clamp(level, 1.0, double(pyramid.levels.size())));
}

Colours add_colours(FrameGraph& graph, const Kernels& kernels, Resource scene, VkExtent2D extent) {
    constexpr uint32_t tile = shared::kColourTile;
    const VkExtent2D tiles{(extent.width + tile - 1) / tile, (extent.height + tile - 1) / tile};
    const Resource colours = graph.transient("colours", image_shape(kSceneFormat, tiles));
    graph.dispatch("colours", kernels.colours, {load(scene), store(colours)}, shared::ColoursPush{{extent.width, extent.height}, {tiles.width, tiles.height}},
                   cover(tiles.width, tiles.height, kernels.colours.group[0], kernels.colours.group[1]));
    return {colours, tiles};
}

}  // namespace vesper
