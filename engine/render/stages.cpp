#include "render/stages.h"

#include <string>

#include "base/error.h"
#include "render/passes/acuity.h"
#include "render/passes/bands.h"
#include "render/passes/composite.h"
#include "render/passes/corona.h"
#include "render/passes/projection.h"

namespace vesper::render {
namespace {

using graph::Resource;

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
std::span<const glm::vec4> pattern_of(const eye::Corona* corona) {
    return corona ? std::span<const glm::vec4>(corona->texels) : std::span<const glm::vec4>();
}

// Of the picture, or of a projector that shows it.
Resource add_codes(const FrameContext& frame, const CompositeInputs& in, const CompositeSettings& codes,
                   const eye::Projection* projection) {
    if (!projection) return add_composite(frame, in, codes);
    return add_projection(frame, add_shown_light(frame, in, codes), *projection, {codes.display, codes.blue_first});
}

shared::ToneParameters parameters_of(const ToneChainSettings& settings, const FovealView& fovea, float seconds) {
    return tone_parameters(operator_info(settings.tone_operator), settings.histogram, settings.tone, settings.display,
                           fovea, seconds);
}

}  // namespace

Resource add_retina(const FrameContext& frame, Resource light, const ScatterInputs& scatter,
                    const eye::Corona* corona) {
    const Resource retina = add_eye_scatter(frame, light, scatter);
    return add_corona(frame, light, retina, pattern_of(corona));
}

Statistics add_statistics(const FrameContext& frame, Resource retina, const ToneChainSettings& settings) {
    const OperatorInfo& op = operator_info(settings.tone_operator);
    Statistics made{.luminance = add_pyramid(frame, retina, settings.tone.operators.reinhard.log_epsilon)};
    const uint32_t level = settings.foveal_level.value_or(foveal_level(frame.view, made.luminance));
    made.fovea = {level, made.luminance.extents[level - 1], frame.view.extent};
    made.gaze = parameters_of(settings, made.fovea, 0).gaze;
    made.histogram = add_histogram(frame, made.luminance, level, votes_of(op, settings));
    made.colours = add_colours(frame, retina, op.chromatic);
    return made;
}

Adaptation add_adaptation_to(const FrameContext& frame, const Statistics& statistics, const ToneChainSettings& settings,
                             const EyeState& eye, float seconds) {
    const std::vector<Resource>& levels = statistics.luminance.levels;
    return add_adaptation(
        frame, {levels.back(), levels[statistics.fovea.level - 1], statistics.histogram, statistics.colours, eye},
        operator_info(settings.tone_operator), parameters_of(settings, statistics.fovea, seconds));
}

Shown add_show(const FrameContext& frame, Resource retina, const Statistics& statistics, Resource curve,
               const ToneChainSettings& settings, const ShowOutputs& outputs) {
    const OperatorInfo& op = operator_info(settings.tone_operator);
    const auto& [luminance, fovea, gaze, histogram, colours] = statistics;
    Resource picture = add_acuity(frame, retina, luminance, fovea.level, settings.tone.acuity_loss);
    picture = add_bands(frame, picture, luminance, fovea.level, curve,
                        {op.bands, tone_of(op, settings.tone), parameters_of(settings, fovea, 0)});
    const Resource bloom =
        add_bloom(frame, picture, curve, display_tone_of(op, settings.tone), settings.display, bloom_of(settings));
    const CompositeInputs composite{picture, curve, bloom};
    Shown shown{};
    shown.codes = add_codes(frame, composite, codes_of(op, settings, outputs.image), outputs.projection);
    if (outputs.image) frame.graph.copy("show", shown.codes, frame.graph.target("shown", *outputs.image));
    shown.display_light = add_display_light(frame, composite, light_of(op, settings), outputs.display_light);
    return shown;
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
