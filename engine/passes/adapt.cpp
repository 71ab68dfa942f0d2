#include "passes/passes.h"

namespace vesper {

Adaptation add_adaptation(FrameGraph& graph, const Kernels& kernels, const Pyramid& pyramid, Resource histogram, const HistogramSettings& bins, const ToneSettings& tone, const Display& display, float seconds) {
    const Adaptation adaptation{graph.transient("tone curve", buffer_shape(sizeof(shared::ToneCurve), VK_FORMAT_R32_SFLOAT)),
                                graph.history("eye", buffer_shape(sizeof(shared::EyeState)))};
    const shared::AdaptPush push{.bins = bins.bins,
                                 .ln_low = bins.ln_low(),
                                 .bins_per_ln = bins.bins_per_ln(),
                                 .display_low = display.low(),
                                 .display_high = display.high(),
                                 .key = tone.key,
                                 .white = tone.white,
                                 .linear_low = tone.linear_low,
                                 .linear_high = tone.linear_high,
                                 .seconds = seconds};
    graph.dispatch("adapt", kernels.adapt,
                   {load(pyramid.levels.back()), load(histogram), load(adaptation.eye.previous), store(adaptation.eye.current), store(adaptation.curve)},
                   push, Groups{});
    return adaptation;
}

}  // namespace vesper
