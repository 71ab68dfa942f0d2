#include "render/passes/acuity.h"

#include <algorithm>

#include "shaders/acuity/acuity.comp.inc"
#include "shared/luminance.h"

namespace vesper::render {
namespace {

using graph::load, graph::store;

constexpr gpu::Shader kAcuity{"acuity.comp", acuity_comp};

}  // namespace

graph::Resource add_acuity(const FrameContext& frame, graph::Resource scene, const Pyramid& pyramid,
                           uint32_t foveal_level, bool loss) {
    if (!loss) return scene;
    const gpu::Kernel& kernel = frame.kernels.get(kAcuity);
    const auto [width, height] = frame.view.extent;
    const uint32_t levels = std::min(shared::kAcuityLevels, uint32_t(pyramid.levels.size()));
    const auto level = [&](uint32_t k) { return load(pyramid.levels[std::min(k, levels) - 1]); };
    const graph::Resource seen = frame.graph.transient("seen", graph::image_shape(kSceneFormat, frame.view.extent));
    frame.graph.dispatch(
        "acuity", kernel,
        {load(scene), load(pyramid.levels.at(foveal_level - 1)), level(1), level(2), level(3), level(4), level(5),
         store(seen)},
        shared::AcuityPush{{width, height}, float(1 / frame.view.degrees_per_pixel()), foveal_level, levels},
        graph::cover(width, height, kernel.group[0], kernel.group[1]));
    return seen;
}

}  // namespace vesper::render
