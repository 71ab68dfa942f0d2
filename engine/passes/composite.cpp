#include "passes/passes.h"

namespace vesper {

Resource add_composite(FrameGraph& graph, const Kernels& kernels, const CompositeInputs& in, uint32_t tone, const View& view, const Display& display, float ldr_glare_gain) {
    const Resource image = graph.transient("display", image_shape(kDisplayFormat, view.extent));
    const Kernel& kernel = kernels.composite[Kernels::composite_index(tone, bool(in.luminance_glare), bool(in.ldr_glare))];
    const shared::CompositePush push{{view.extent.width, view.extent.height}, display.low(), display.high(), 1 / display.gamma, ldr_glare_gain};
    // A binding that the variant does not read still has to be bound: the scene stands in.
    graph.dispatch("composite", kernel,
                   {load(in.scene), sample(in.curve), load(in.luminance_glare ? in.luminance_glare : in.scene), sample(in.ldr_glare ? in.ldr_glare : in.scene), store(image)},
                   push, cover(view.extent.width, view.extent.height, kernel.group[0], kernel.group[1] * kernels.composite_rows));
    return image;
}

}  // namespace vesper
