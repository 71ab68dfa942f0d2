#include "render/tone_chain.h"

#include "graph/times.h"
#include "render/passes/acuity.h"
#include "render/passes/bands.h"
#include "render/passes/composite.h"
#include "render/passes/corona.h"
#include "render/passes/projection.h"

namespace vesper::render {
namespace {

using graph::Resource;

template <class T>
void read_all(const graph::Executor& executor, Resource readback, std::vector<T>& to) {
    to.clear();
    if (!readback) return;
    const auto values = executor.read_as<T>(readback);
    to.assign(values.begin(), values.end());
}

// How pixels are mapped by an operator, and how dim light is perceived: shared::kTone* and kGamut*.
uint32_t tone_of(const OperatorInfo& op, const ToneSettings& tone) {
    return op.form | (tone.colour_loss ? shared::kToneColourLoss : 0) | (tone.purkinje ? shared::kTonePurkinje : 0) |
           (tone.photopic_rods ? shared::kTonePhotopicRods : 0) | tone.gamut;
}

// The same for the display: bands have mapped the picture already.
uint32_t display_tone_of(const OperatorInfo& op, const ToneSettings& tone) {
    return op.bands ? shared::kToneLinear | tone.gamut : tone_of(op, tone);
}

// Fine votes are for curves that the histogram makes, and for automatic parameters.
HistogramSettings votes_of(const OperatorInfo& op, const ToneChainSettings& settings) {
    HistogramSettings votes = settings.histogram;
    votes.fine = votes.fine && settings.tone.operators.uses_histogram(op.tone_operator);
    return votes;
}

BloomSettings bloom_of(const ToneChainSettings& settings) {
    BloomSettings bloom = settings.bloom;
    if (settings.glare != Glare::Ldr) bloom.gain = 0;
    return bloom;
}

// Codes in the format of an external image, or those of the display.
CompositeSettings codes_of(const OperatorInfo& op, const ToneChainSettings& settings,
                           const std::optional<graph::ExternalImage>& shown) {
    CompositeSettings codes{
        .tone = display_tone_of(op, settings.tone), .display = settings.display, .bloom_gain = settings.bloom.gain};
    if (!shown) return codes;
    const auto format = shown_format(shown->format);
    if (!format) throw Error("codes cannot be shown in an image of Vulkan format " + std::to_string(shown->format));
    codes.display.bits = format->bits, codes.blue_first = format->blue_first;
    return codes;
}

CompositeSettings light_of(const OperatorInfo& op, const ToneChainSettings& settings) {
    return codes_of(op, settings, {});
}

// The texels of needles and halo; none without them.
std::span<const glm::vec4> pattern_of(const gpu_scene::Corona* corona) {
    return corona ? std::span<const glm::vec4>(corona->texels) : std::span<const glm::vec4>();
}

// Of the picture, or of a projector that shows it.
Resource add_codes(const FrameContext& frame, const CompositeInputs& in, const CompositeSettings& codes,
                   const gpu_scene::Projection* projection) {
    if (!projection) return add_composite(frame, in, codes);
    return add_projection(frame, add_shown_light(frame, in, codes), *projection, {codes.display, codes.blue_first});
}

void show(graph::FrameGraph& graph, Resource codes, const std::optional<graph::ExternalImage>& image) {
    if (image) graph.copy("show", codes, graph.target("shown", *image));
}

ViewStatistics statistics_of(const graph::Executor& executor, const ToneChain& chain) {
    const glm::uvec2 size(chain.foveal_view.texels.width, chain.foveal_view.texels.height);
    ViewStatistics statistics{
        .histogram = read_one<shared::Histogram>(executor, chain.histogram),
        .whole = read_one<glm::vec4>(executor, chain.whole),
        .fovea = texels_about(executor.read_as<glm::vec4>(chain.fovea), size, chain.gaze),
        .colours = {},
    };
    read_all(executor, chain.colours, statistics.colours);
    return statistics;
}

}  // namespace

Resource add_readback(graph::FrameGraph& graph, const std::string& name, Resource from, uint64_t bytes, bool wanted) {
    if (!wanted) return {};
    const Resource to = graph.readback(name + " on the host", bytes);
    graph.copy("read " + name, from, to);
    return to;
}

ToneChain add_tone_chain(const FrameContext& frame, Resource scene, const ToneChainSettings& settings,
                         const ChainInputs& inputs, const Outputs& outputs) {
    const OperatorInfo& op = operator_info(settings.tone_operator);
    const uint64_t pixels = uint64_t(frame.view.extent.width) * frame.view.extent.height;
    ToneChain chain{.shown_extent = outputs.projection ? outputs.projection->extent : frame.view.extent};

    // The eye adapts to the light that falls on the retina, and the histogram counts it.
    Resource retina = add_eye_scatter(frame, scene, inputs.scatter);
    retina = add_corona(frame, scene, retina, pattern_of(inputs.corona));
    if (outputs.retina) {
        chain.retina = add_readback(frame.graph, "retina", retina, pixels * 16);
        chain.scene = add_readback(frame.graph, "scene", scene, pixels * 16, outputs.scene);
        return chain;
    }

    const Pyramid luminance = add_pyramid(frame, retina, settings.tone.operators.reinhard.log_epsilon);
    const uint32_t level = settings.foveal_level.value_or(foveal_level(frame.view, luminance));
    const Resource histogram = add_histogram(frame, luminance, level, votes_of(op, settings));
    const Colours colours = add_colours(frame, retina, op.chromatic);
    const FovealView fovea{level, luminance.extents[level - 1], frame.view.extent};
    const shared::ToneParameters parameters =
        tone_parameters(op, settings.histogram, settings.tone, settings.display, fovea, inputs.seconds);
    chain.foveal_level = level;
    chain.retina_light = retina, chain.whole_retina = luminance.levels.back();
    if (outputs.statistics) {
        const auto texels = [&](const char* name, Resource image, VkExtent2D size) {
            return add_readback(frame.graph, name, image, uint64_t(size.width) * size.height * sizeof(glm::vec4),
                                bool(image));
        };
        chain.histogram = add_readback(frame.graph, "histogram", histogram, sizeof(shared::Histogram));
        chain.whole = texels("all of the picture", luminance.levels.back(), {1, 1});
        chain.fovea = texels("fovea", luminance.levels[level - 1], fovea.texels);
        chain.colours = texels("colours", colours.tiles, colours.extent);
        chain.foveal_view = fovea, chain.gaze = parameters.gaze;
        return chain;
    }
    const auto [curve, eye] =
        inputs.curve
            ? Adaptation{frame.graph.upload("tone curve", std::vector{*inputs.curve}, VK_FORMAT_R32G32B32A32_SFLOAT),
                         {}}
            : add_adaptation(frame,
                             {luminance.levels.back(), luminance.levels[level - 1], histogram, colours, inputs.eye}, op,
                             parameters);

    Resource picture = add_acuity(frame, retina, luminance, level, settings.tone.acuity_loss);
    picture = add_bands(frame, picture, luminance, level, curve, {op.bands, tone_of(op, settings.tone), parameters});
    const Resource bloom =
        add_bloom(frame, picture, curve, display_tone_of(op, settings.tone), settings.display, bloom_of(settings));
    const CompositeInputs composite{picture, curve, bloom};
    const Resource codes = add_codes(frame, composite, codes_of(op, settings, outputs.shown), outputs.projection);
    show(frame.graph, codes, outputs.shown);

    if (!inputs.curve) {
        chain.curve = add_readback(frame.graph, "tone curve", curve, sizeof(shared::ToneCurve));
        chain.histogram = add_readback(frame.graph, "histogram", histogram, sizeof(shared::Histogram));
        chain.eye = add_readback(frame.graph, "eye", eye, sizeof(shared::EyeState));
    }
    const uint64_t shown_pixels = uint64_t{chain.shown_extent.width} * chain.shown_extent.height;
    chain.display = add_readback(frame.graph, "display", codes, shown_pixels * 4, outputs.display);
    const Resource light = add_display_light(frame, composite, light_of(op, settings), outputs.display_light);
    chain.display_light = add_readback(frame.graph, "display light", light, pixels * 16, outputs.display_light);
    chain.scene = add_readback(frame.graph, "scene", scene, pixels * 16, outputs.scene);
    return chain;
}

void read_tone_chain(const graph::Executor& executor, const ToneChain& chain, VkExtent2D extent, ToneMapped& to) {
    to.extent = extent, to.shown_extent = chain.shown_extent;
    read_all(executor, chain.display, to.display);
    read_all(executor, chain.scene, to.scene);
    read_all(executor, chain.retina, to.retina);
    read_all(executor, chain.display_light, to.display_light);
    if (chain.curve) {
        to.curve = read_one<shared::ToneCurve>(executor, chain.curve);
        to.histogram = read_one<shared::Histogram>(executor, chain.histogram);
        to.eye = read_one<shared::EyeState>(executor, chain.eye);
    }
    if (chain.whole) to.statistics = statistics_of(executor, chain);
    to.foveal_level = chain.foveal_level;
    to.timings.clear();
    graph::add_times(to.timings, executor.timings());  // passes of one name are counted together
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

}  // namespace vesper::render
