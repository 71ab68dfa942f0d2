#include "render/tone_chain.h"

namespace vesper {
namespace {

template <class T>
void read_all(const Executor& executor, Resource readback, std::vector<T>& to) {
    to.clear();
    if (!readback) return;
    const auto values = executor.read_as<T>(readback);
    to.assign(values.begin(), values.end());
}

}  // namespace

Resource add_readback(FrameGraph& graph, const std::string& name, Resource from, uint64_t bytes) {
    const Resource to = graph.readback(name + " on the host", bytes);
    graph.copy("read " + name, from, to);
    return to;
}

ToneChain add_tone_chain(FrameGraph& graph, const Kernels& kernels, Resource rendered, const View& view, const ToneChainSettings& settings, const ChainInputs& given, Outputs outputs) {
    const OperatorInfo& op = operator_info(settings.tone_operator);
    uint32_t tone = op.form | (settings.tone.colour_loss ? shared::kToneColourLoss : 0) | (settings.tone.purkinje ? shared::kTonePurkinje : 0) |
                    (settings.tone.photopic_rods ? shared::kTonePhotopicRods : 0) | settings.tone.gamut;
    // What the eye adapts to and the histogram counts is what falls on the retina.
    Resource scene = rendered;
    if (given.scatter) scene = add_scatter(graph, kernels, rendered, *given.scatter, given.outside, given.beyond);
    if (given.scatter && given.corona) scene = add_corona(graph, kernels, rendered, scene, given.corona->texels, view);
    const uint64_t pixels = uint64_t(view.extent.width) * view.extent.height;
    if (outputs.retina) {
        ToneChain chain;
        chain.retina = add_readback(graph, "retina", scene, pixels * 16);
        if (outputs.scene) chain.scene = add_readback(graph, "scene", rendered, pixels * 16);
        return chain;
    }
    const Pyramid luminance = add_pyramid(graph, kernels, scene, view.extent, settings.tone.log_epsilon);
    const uint32_t level = settings.foveal_level.value_or(foveal_level(view, luminance));
    HistogramSettings votes = settings.histogram;
    // Elsewhere nobody would look at them.
    votes.fine = votes.fine && (op.model == shared::kModelHistogram || op.model == shared::kModelTrimmed || settings.tone.automatic);
    const Resource histogram = add_histogram(graph, kernels, luminance, level, view.extent, votes);
    const FovealView fovea{level, luminance.extents[level - 1], view.extent};
    const shared::ToneParameters parameters = tone_parameters(op, settings.histogram, settings.tone, settings.display, fovea, given.seconds);
    const Adaptation adaptation = add_adaptation(graph, kernels, luminance, histogram, op, parameters, level, given.remembered,
                                                 op.chromatic ? add_colours(graph, kernels, scene, view.extent) : Colours{});
    Resource seen = settings.tone.acuity_loss ? add_acuity(graph, kernels, scene, luminance, level, view) : scene;
    if (op.bands) {
        seen = add_bands(graph, kernels, seen, luminance, level, adaptation.curve, tone, parameters, view.extent);
        tone = shared::kToneLinear | settings.tone.gamut;
    }
    Resource glare;
    if (settings.glare == Glare::Ldr)
        glare = add_bloom(graph, kernels, seen, adaptation.curve, tone, view, settings.display, settings.bloom);
    const auto shown = outputs.shown ? shown_format(outputs.shown->format) : std::nullopt;
    if (outputs.shown && !shown) throw Error("codes cannot be shown in an image of Vulkan format " + std::to_string(outputs.shown->format));
    Display screen = settings.display;
    if (shown) screen.bits = shown->bits;
    const CompositeInputs inputs{.scene = seen, .curve = adaptation.curve, .bloom = glare, .blue_first = shown && shown->blue_first};
    const Resource display = add_composite(graph, kernels, inputs, tone, view, screen, settings.bloom.gain);
    if (shown) graph.copy("show", display, graph.target("shown", *outputs.shown));

    ToneChain chain{.display = {}, .scene = {}, .retina = {}, .display_light = {},
                    .curve = add_readback(graph, "tone curve", adaptation.curve, sizeof(shared::ToneCurve)),
                    .histogram = add_readback(graph, "histogram", histogram, sizeof(shared::Histogram)),
                    .eye = add_readback(graph, "eye", adaptation.eye.current, sizeof(shared::EyeState)),
                    .foveal_level = level};
    if (outputs.display) chain.display = add_readback(graph, "display", display, pixels * 4);
    if (outputs.display_light) {
        const Resource display_light = add_display_light(graph, kernels, inputs, tone, view, settings.display, settings.bloom.gain);
        chain.display_light = add_readback(graph, "display light", display_light, pixels * 16);
    }
    if (outputs.scene) chain.scene = add_readback(graph, "scene", rendered, pixels * 16);
    return chain;
}

void read_tone_chain(const Executor& executor, const ToneChain& chain, VkExtent2D extent, ToneMapped& to) {
    to.extent = extent;
    read_all(executor, chain.display, to.display);
    read_all(executor, chain.scene, to.scene);
    read_all(executor, chain.retina, to.retina);
    read_all(executor, chain.display_light, to.display_light);
    if (chain.curve) {
        to.curve = read_one<shared::ToneCurve>(executor, chain.curve);
        to.histogram = read_one<shared::Histogram>(executor, chain.histogram);
        to.eye = read_one<shared::EyeState>(executor, chain.eye);
    }
    to.foveal_level = chain.foveal_level;
    to.timings = executor.timings();
    to.host_times = executor.host_times();
}

std::optional<ShownFormat> shown_format(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R8G8B8A8_UNORM:
        case VK_FORMAT_R8G8B8A8_SRGB:
        case VK_FORMAT_A8B8G8R8_UNORM_PACK32:
        case VK_FORMAT_A8B8G8R8_SRGB_PACK32:
            return ShownFormat{8, false};
        case VK_FORMAT_B8G8R8A8_UNORM:
        case VK_FORMAT_B8G8R8A8_SRGB:
            return ShownFormat{8, true};
        case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
            return ShownFormat{10, false};
        case VK_FORMAT_A2R10G10B10_UNORM_PACK32:
            return ShownFormat{10, true};
        default:
            return std::nullopt;
    }
}

ChainInputs EyeKeeper::inputs(Executor& executor, const ToneChainSettings& settings, const View& view, float seconds) {
    ChainInputs given{.seconds = seconds, .remembered = given_ ? &*given_ : nullptr, .scatter = nullptr, .corona = nullptr, .outside = {}, .beyond = nullptr};
    if (settings.glare != Glare::Scatter) return given;
    if (!scatter_.has(settings.scatter, view)) executor.wait();  // what is under way uses the one that goes
    given.scatter = &scatter_.at(settings.scatter, view);
    const shared::EyeState& before = given_ ? *given_ : last_;
    if (settings.scatter.has_corona()) given.corona = &corona_.at(settings.scatter, double(before.pupil), double(before.seconds) + double(before.seconds_lost) + double(seconds));
    return given;
}

void EyeKeeper::reset(Executor& executor) {
    executor.reset(kEyeHistory);
    given_.reset();
    last_ = {};
}

}  // namespace vesper
