#include "render/passes/pyramid.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "shaders/pyramid/pyramid.comp.inc"
#include "shared/luminance.h"
#include "shared/photometry.h"

namespace vesper::render {
namespace {

using graph::load, graph::store;

constexpr gpu::Shader kPyramid{"pyramid.comp", pyramid_comp};  // constant 0: 1 for the first level

}  // namespace

Pyramid add_pyramid(const FrameContext& frame, graph::Resource scene, float log_epsilon) {
    VkExtent2D extent = frame.view.extent;
    Pyramid pyramid;
    graph::Resource from = scene;
    do {
        const VkExtent2D half{(extent.width + 1) / 2, (extent.height + 1) / 2};
        const std::string name = "luminance " + std::to_string(pyramid.levels.size() + 1);
        const graph::Resource to = frame.graph.transient(name, graph::image_shape(kSceneFormat, half));
        const gpu::Kernel& kernel = frame.kernels.get(kPyramid, {pyramid.levels.empty()});
        frame.graph.dispatch(name, kernel, {load(from), store(to)},
                             shared::PyramidPush{{extent.width, extent.height},
                                                 {half.width, half.height},
                                                 log_epsilon > 0 ? 0 : shared::kLuminanceFloor,
                                                 log_epsilon,
                                                 0},
                             graph::cover(half.width, half.height, kernel.group[0], kernel.group[1]));
        pyramid.levels.push_back(to);
        pyramid.extents.push_back(half);
        from = to;
        extent = half;
    } while (extent.width > 1 || extent.height > 1);
    return pyramid;
}

uint32_t foveal_level(const gpu_scene::View& view, const Pyramid& pyramid) {
    const double level = std::round(std::log2(1 / view.degrees_per_pixel()));
    return uint32_t(std::clamp(level, 1.0, double(pyramid.levels.size())));
}

LevelTexels add_overlapping(const FrameContext& frame, const std::string& name, const LevelTexels& of, uint32_t apart) {
    const VkExtent2D size = of.extent, larger{size.width + apart, size.height + apart};
    const gpu::Kernel& kernel = frame.kernels.get(kPyramid, {0});
    const graph::Resource to = frame.graph.transient(name, graph::image_shape(kSceneFormat, larger));
    frame.graph.dispatch(name, kernel, {load(of.texels), store(to)},
                         shared::PyramidPush{{size.width, size.height}, {larger.width, larger.height}, 0, 0, apart},
                         graph::cover(larger.width, larger.height, kernel.group[0], kernel.group[1]));
    return {to, larger};
}

}  // namespace vesper::render
