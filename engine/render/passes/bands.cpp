#include "render/passes/passes.h"
#include "shared/bands.h"

namespace vesper {

Resource add_bands(FrameGraph& graph, const Kernels& kernels, Resource scene, const Pyramid& pyramid, uint32_t foveal_level, Resource curve, uint32_t tone, const shared::ToneParameters& parameters, VkExtent2D extent) {
    Resource shown;
    for (uint32_t level = foveal_level + 1; level-- > 0;) {
        const uint32_t band = level == foveal_level ? shared::kBandTop : level > 0 ? shared::kBandMiddle : shared::kBandFinest;
        const Resource here = level == 0 ? scene : pyramid.levels[level - 1], above = band == shared::kBandTop ? here : shown;
        const VkExtent2D size = level == 0 ? extent : pyramid.extents[level - 1], coarse = pyramid.extents[std::min(level, foveal_level - 1)];
        const std::string name = level == 0 ? "bands" : "bands " + std::to_string(level);
        shown = graph.transient(name, image_shape(kSceneFormat, size));
        const Kernel& kernel = kernels.bands({tone, band});
        graph.dispatch(name, kernel, {load(here), load(above), sample(curve), store(shown)},
                       shared::BandsPush{{size.width, size.height}, {coarse.width, coarse.height}, parameters.cone_break, parameters.viewer_sigma, parameters.viewer_step},
                       cover(size.width / 2 + 1, size.height / 2 + 1, kernel.group[0], kernel.group[1]));
    }
    return shown;
}

}  // namespace vesper
