#include "render/passes/bands.h"

#include "shaders/bands/bands.comp.inc"
#include "shared/bands.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store;

constexpr gpu::Shader kBands{"bands.comp", bands_comp};

}  // namespace

graph::Resource add_bands(const FrameContext& frame, graph::Resource scene, const Pyramid& pyramid,
                          uint32_t foveal_level, graph::Resource curve, const BandsSettings& settings) {
    if (!settings.on) return scene;
    const shared::ToneParameters& parameters = settings.parameters;
    graph::Resource shown;
    for (uint32_t level = foveal_level + 1; level-- > 0;) {
        const uint32_t band = level == foveal_level ? shared::kBandTop
                              : level > 0           ? shared::kBandMiddle
                                                    : shared::kBandFinest;
        const graph::Resource here = level == 0 ? scene : pyramid.levels[level - 1],
                              above = band == shared::kBandTop ? here : shown;
        const VkExtent2D size = level == 0 ? frame.view.extent : pyramid.extents[level - 1],
                         coarse = pyramid.extents[std::min(level, foveal_level - 1)];
        const std::string name = level == 0 ? "bands" : "bands " + std::to_string(level);
        shown = frame.graph.transient(name, graph::image_shape(kSceneFormat, size));
        const gpu::Kernel& kernel = frame.kernels.get(kBands, {settings.tone, band});
        frame.graph.dispatch(name, kernel, {load(here), load(above), sample(curve), store(shown)},
                             shared::BandsPush{{size.width, size.height},
                                               {coarse.width, coarse.height},
                                               parameters.cone_break,
                                               parameters.viewer_sigma,
                                               parameters.viewer_step},
                             graph::cover(size.width / 2 + 1, size.height / 2 + 1, kernel.group[0], kernel.group[1]));
    }
    return shown;
}

}  // namespace vesper::render
