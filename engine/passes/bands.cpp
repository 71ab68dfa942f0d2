#include "passes/passes.h"
#include "shared/bands.h"

namespace vesper {

Resource add_bands(FrameGraph& graph, const Kernels& kernels, Resource scene, const Pyramid& pyramid, uint32_t foveal_level, Resource curve, uint32_t tone, float cone_break, VkExtent2D extent) {
    Resource shown;
    for (uint32_t level = foveal_level; level-- > 0;) {
        const bool topmost = level + 1 == foveal_level, finest = level == 0;
        const Resource finer = finest ? scene : pyramid.levels[level - 1], coarser = pyramid.levels[level];
        const VkExtent2D size = finest ? extent : pyramid.extents[level - 1], above = pyramid.extents[level];
        const Resource made = graph.transient(finest ? "bands" : "bands " + std::to_string(level), image_shape(kSceneFormat, size));
        const Kernel& kernel = kernels.bands({tone, topmost, finest});
        graph.dispatch(finest ? "bands" : "bands " + std::to_string(level), kernel, {load(finer), load(coarser), load(topmost ? coarser : shown), sample(curve), store(made)},
                       shared::BandsPush{{size.width, size.height}, {above.width, above.height}, cone_break},
                       cover(size.width, size.height, kernel.group[0], kernel.group[1]));
        shown = made;
    }
    return shown;
}

}  // namespace vesper
