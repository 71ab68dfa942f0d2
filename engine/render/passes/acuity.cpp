#include <algorithm>

#include "render/passes/passes.h"

namespace vesper {

Resource add_acuity(FrameGraph& graph, const Kernels& kernels, Resource scene, const Pyramid& pyramid, uint32_t foveal_level, const View& view) {
    const auto [width, height] = view.extent;
    const uint32_t levels = std::min(shared::kAcuityLevels, uint32_t(pyramid.levels.size()));
    const auto level = [&](uint32_t k) { return load(pyramid.levels[std::min(k, levels) - 1]); };
    const Resource seen = graph.transient("seen", image_shape(kSceneFormat, view.extent));
    graph.dispatch("acuity", kernels.acuity, {load(scene), load(pyramid.levels.at(foveal_level - 1)), level(1), level(2), level(3), level(4), level(5), store(seen)},
                   shared::AcuityPush{{width, height}, float(1 / view.degrees_per_pixel()), foveal_level, levels},
                   cover(width, height, kernels.acuity.group[0], kernels.acuity.group[1]));
    return seen;
}

}  // namespace vesper
