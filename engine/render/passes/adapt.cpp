#include "render/passes/adapt.h"

#include <algorithm>

#include "shaders/adapt/adapt.comp.inc"
#include "shared/photometry.h"

namespace vesper::render {
namespace {

using graph::load, graph::store;

constexpr gpu::Shader kAdapt{"adapt.comp", adapt_comp};
constexpr const char* kEyeHistory = "eye";  // on the device, from frame to frame

shared::ReceptorParameters receptors_of(vision::ReceptorKind kind, const vision::Receptors& r,
                                        vision::ThresholdBreaks breaks) {
    const vision::ReceptorModel model(kind, r, breaks);
    return {.response_step = float(model.response_step()),
            .dark_sigma = float(model.dark_sigma()),
            .factor = float(r.threshold_factor),
            .fast_seconds = float(r.fast_seconds),
            .slow_seconds = float(r.slow_seconds),
            .fast_share = float(r.fast_share),
            .bleach_seconds = float(r.bleach_seconds),
            .bleach_trolands = float(r.bleach_trolands)};
}

}  // namespace

shared::ToneParameters tone_parameters(const OperatorInfo& op, const HistogramSettings& bins, const ToneSettings& tone,
                                       const vision::Display& display, const FovealView& fovea, float seconds) {
    const uint32_t ceiling = tone.ceiling.value_or(op.ceiling);
    // What others have computed with the published curves is to be met; an eye that adapts needs continuous ones.
    const vision::ThresholdBreaks breaks = ceiling == shared::kCeilingEye || op.bands
                                               ? vision::ThresholdBreaks::continuous()
                                               : vision::ThresholdBreaks::published();
    const vision::ReceptorModel viewer(vision::ReceptorKind::Cones, vision::Receptors::cones());
    const float texel = float(1u << fovea.level);
    const OperatorBlock block = tone.operators.block(op.tone_operator, display);
    return {.bins = bins.bins,
            .steps_per_bin = bins.steps_per_bin(),
            .window = bins.window(),
            .ln_low = bins.ln_low(),
            .bins_per_ln = bins.bins_per_ln(),
            .display_low = display.low(),
            .display_high = display.high(),
            .seconds = seconds,
            .smoothing_seconds = tone.smoothing_seconds,
            .adapt_to = tone.adapt_to.value_or(op.adapt_to),
            .gaze = tone.gaze * glm::vec2(fovea.image.width, fovea.image.height) / texel,
            .foveal_size = {fovea.texels.width, fovea.texels.height},
            .ceiling = ceiling,
            .use_rods = tone.observer.use_rods ? 1u : 0u,
            .cone_break = float(breaks.cones),
            .rod_break = float(breaks.rods),
            .scotopic = tone.photopic_rods ? 1 : shared::kScotopicOfWhite,
            .colour_tiles = {},
            .viewer_sigma = float(viewer.adapted_sigma(double(display.high()) * double(shared::kViewerOfWhite))),
            .viewer_step = float(viewer.response_step()),
            .cones = receptors_of(vision::ReceptorKind::Cones, tone.observer.observed_cones(), breaks),
            .rods = receptors_of(vision::ReceptorKind::Rods, tone.observer.observed_rods(), breaks),
            .settings = {block[0], block[1]}};
}

Adaptation add_adaptation(const FrameContext& frame, const AdaptationInputs& inputs, const OperatorInfo& op,
                          shared::ToneParameters parameters) {
    const auto& [whole, fovea, histogram, colours, eye] = inputs;
    parameters.colour_tiles = {colours.extent.width, colours.extent.height};
    const graph::Resource curve = frame.graph.transient(
        "tone curve", graph::buffer_shape(sizeof(shared::ToneCurve), VK_FORMAT_R32G32B32A32_SFLOAT));
    const graph::History history = frame.graph.history(kEyeHistory, graph::buffer_shape(sizeof(shared::EyeState)));
    // Declared in both cases: frames with the same resources keep their memory.
    const graph::Resource value = frame.graph.upload("eye of the host", std::vector{eye.value});
    frame.graph.dispatch("adapt", frame.kernels.get(kAdapt, {uint32_t(op.tone_operator)}),
                         {load(whole), load(fovea), load(histogram),
                          load(frame.graph.upload("tone parameters", std::vector{parameters})),
                          load(eye.on_device ? history.previous : value), store(history.current), store(curve),
                          load(colours.tiles ? colours.tiles : whole)},
                         graph::Groups{});
    return {curve, history.current};
}

}  // namespace vesper::render
