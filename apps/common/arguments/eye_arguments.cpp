#include "arguments/eye_arguments.h"

#include <map>

#include "arguments/arguments.h"

namespace vesper::apps {
namespace {

const std::map<std::string, uint32_t> kAdaptTo{{"gaze", shared::kAdaptGaze},
                                               {"gaze-mean", shared::kAdaptGazeMean},
                                               {"texel", shared::kAdaptTexel},
                                               {"average", shared::kAdaptAverage}};
const std::map<std::string, uint32_t> kCeilings{{"eye", shared::kCeilingEye},
                                                {"human", shared::kCeilingHuman},
                                                {"cones", shared::kCeilingCones},
                                                {"linear", shared::kCeilingLinear}};

template <class T>
std::vector<std::string> names_of(const std::map<std::string, T>& values) {
    std::vector<std::string> names{"operator"};
    for (const auto& [name, value] : values) names.push_back(name);
    return names;
}

std::vector<std::string> operator_names() {
    std::vector<std::string> names;
    for (const render::OperatorInfo& op : render::operators()) names.emplace_back(op.name);
    return names;
}

std::string operator_help() {
    std::string help = "How luminance is shown";
    for (const render::OperatorInfo& op : render::operators())
        help += "\n  " + std::string(op.name) + ": " + std::string(op.summary);
    return help;
}

bool given(const EyeArguments& arguments, const char* name) { return arguments.command.count(name) > 0; }

}  // namespace

void add_eye_options(Command command, EyeArguments& arguments, render::HistogramSettings& histogram,
                     render::ToneSettings& tone) {
    vision::Observer& observer = tone.observer;
    arguments.command = command;
    command.add_option("--operator", arguments.tone_operator, operator_help())
        .check(one_of(operator_names()))
        .shows_default();
    command.help_group("Operators and their curves");
    command
        .add_option("--preset", arguments.preset,
                    "paper: irawan with cones only, 100 bins, whole votes of level 5 alone, adapted to its texel at "
                    "the gaze, no smoothing (at its 1680x1050, the default size)")
        .check(one_of({"none", "paper"}))
        .shows_default();
    command.add_option("--bins", histogram.bins, "Bins of the histogram")
        .check(range(1u, shared::kMaxBins))
        .shows_default();
    command
        .add_option("--foveal-level", arguments.foveal_level,
                    "Pyramid level of the histogram (default: 1 degree per texel; the paper: 5)")
        .check(range(1, 14));
    command.add_flag("--whole-votes", arguments.whole_votes, "Histogram: whole votes of the foveal level alone");
    command
        .add_option("--smoothing", tone.smoothing_seconds,
                    "Curve: time constant against flicker, s; no model of the eye; 0: none")
        .check(between(0.0, 60.0))
        .shows_default();
    command
        .add_option("--ceiling", arguments.ceiling,
                    "irawan, ward: thresholds that bound contrast: of the eye in its state, adapted human, adapted "
                    "cones, or none (linear)")
        .check(one_of(names_of(kCeilings)))
        .shows_default();
    command.help_group("The eye");
    command
        .add_option(
            "--adapt-to", arguments.adapt_to,
            "What the eye adapts to: log average or mean about the gaze, one texel, or the log average of the frame")
        .check(one_of(names_of(kAdaptTo)))
        .shows_default();
    command.add_option("--gaze", arguments.gaze, "Where the eye looks: X,Y, parts of the image from its top left")
        .separated_by(',')
        .values(2)
        .check(between(0.0, 1.0));
    command.add_flag("--colour-loss", tone.colour_loss,
                     "Dim light loses its colour (from 5.62 down to 0.00562 cd/m^2)");
    command.add_flag("--acuity-loss", tone.acuity_loss, "Dim light is blurred as far as it cannot be resolved");
    command.add_flag("--purkinje", tone.purkinje, "Dim light is weighted as rods do: blue brighter, red darker");
    command.add_flag("--photopic-rods", tone.photopic_rods,
                     "Rods take luminance for scotopic luminance (as pfstools); without: that of the colour");
    command.help_group();
    command.add_option("--age", observer.age, "Age of the observer, years").check(between(1.0, 120.0)).shows_default();
    command.help_group("The eye");
    command.add_option("--low-vision", observer.low_vision, "Observer: factor of all thresholds")
        .check(between(0.1, 100.0))
        .shows_default();
    command.add_flag("--rods", observer.use_rods, "Observer: rods see too, not only cones");
    command
        .add_option("--semi-saturation", observer.cones.semi_saturation,
                    "Observer: c, half saturation over luminance in daylight")
        .check(between(1.0, 100.0))
        .shows_default();
    command
        .add_option("--fast-seconds", observer.cones.fast_seconds,
                    "Observer: fast neural adaptation of cones, time constant, s")
        .check(between(1e-3, 10.0))
        .shows_default();
    command
        .add_option("--slow-seconds", observer.cones.slow_seconds,
                    "Observer: slow neural adaptation of cones, time constant, s")
        .check(between(1e-3, 1e4))
        .shows_default();
    command
        .add_option("--fast-share", observer.cones.fast_share,
                    "Observer: part of the neural adaptation of cones that is fast")
        .check(between(0.0, 1.0))
        .shows_default();
    command
        .add_option("--bleach-seconds", observer.cones.bleach_seconds, "Observer: pigment of cones, time constant, s")
        .check(between(1e-3, 1e5))
        .shows_default();
    command
        .add_option("--bleach-trolands", observer.cones.bleach_trolands,
                    "Observer: what bleaches half of the pigment of cones, td")
        .check(between(1.0, 1e9))
        .shows_default();
    command.help_group();
}

void apply(const EyeArguments& arguments, render::ToneChainSettings& settings) {
    const bool paper = arguments.preset == "paper";
    for (const render::OperatorInfo& op : render::operators())
        if (op.name == (paper && !given(arguments, "--operator") ? "irawan" : arguments.tone_operator))
            settings.tone_operator = op.tone_operator;
    render::ToneSettings& tone = settings.tone;
    if (const auto found = kAdaptTo.find(arguments.adapt_to); found != kAdaptTo.end()) tone.adapt_to = found->second;
    if (const auto found = kCeilings.find(arguments.ceiling); found != kCeilings.end()) tone.ceiling = found->second;
    tone.gaze = {arguments.gaze.at(0), arguments.gaze.at(1)};
    if (arguments.foveal_level > 0) settings.foveal_level = uint32_t(arguments.foveal_level);
    settings.histogram.split = settings.histogram.fine = settings.histogram.overlap = !arguments.whole_votes && !paper;
    if (paper && !given(arguments, "--bins")) settings.histogram.bins = 100;
    if (paper && !given(arguments, "--foveal-level")) settings.foveal_level = 5;
    if (paper && !given(arguments, "--smoothing")) tone.smoothing_seconds = 0;
    if (paper && !given(arguments, "--adapt-to")) tone.adapt_to = shared::kAdaptTexel;
}

}  // namespace vesper::apps
