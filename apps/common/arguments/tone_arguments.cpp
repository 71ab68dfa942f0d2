#include "arguments/tone_arguments.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "base/error.h"
#include "print.h"
#include "tone_log.h"

namespace vesper::apps {
namespace {

using render::Glare;

struct NamedGlare {
    const char* name;
    Glare glare;
    eye::ScatterSettings::Model model = eye::ScatterSettings::Model::Cie;
};
constexpr NamedGlare kGlares[]{{"none", Glare::None},
                               {"cie", Glare::Scatter, eye::ScatterSettings::Model::Cie},
                               {"temporal", Glare::Scatter, eye::ScatterSettings::Model::Temporal},
                               {"spencer", Glare::Scatter, eye::ScatterSettings::Model::Spencer},
                               {"ward", Glare::Scatter, eye::ScatterSettings::Model::Ward},
                               {"ldr", Glare::Ldr}};
const std::map<std::string, uint32_t> kGamuts{
    {"luminance", shared::kGamutLuminance}, {"chromaticity", shared::kGamutChromaticity}, {"clip", shared::kGamutClip}};
const std::map<std::string, vision::SpencerState> kPupils{{"photopic", vision::SpencerState::Photopic},
                                                          {"mesopic", vision::SpencerState::Mesopic},
                                                          {"scotopic", vision::SpencerState::Scotopic}};

/// Adds the settings of an operator to a command.
struct OperatorOptions {
    Command& command;
    void operator()(const render::OperatorOption& option, float& value) const {
        Option added = command.add_option(option.name, value, option.help).check(between(option.low, option.high));
        if (option.shows_default) added.shows_default();
    }
    void operator()(const render::OperatorOption& option, bool& value) const {
        command.add_flag(option.name, value, option.help);
    }
};

}  // namespace

void add_tone_options(Command command, ToneArguments& a) {
    add_eye_options(command, a.eye, a.histogram, a.tone);
    command
        .add_option("--glare", a.glare,
                    "Light scattered in the eye\n"
                    "  cie: CIE 135/1 total glare function\n"
                    "  spencer: 1995, with needles and halo\n"
                    "  ward: the veil of 1997\n"
                    "  temporal: cie with needles and halo that move, after Ritschel 2009\n"
                    "  ldr: the paper's, on the tone-mapped image; the others are in cd/m^2 before the operator")
        .check(one_of(glare_names()))
        .shows_default();
    command.help_group("Glare");
    command
        .add_option("--iris", a.iris,
                    "cie, temporal: pigmentation of the iris: 0 very dark, 0.5 brown, 1 green, 1.2 light blue")
        .check(between(0.0, 1.5))
        .shows_default();
    command.add_option("--pupil", a.pupil, "spencer: state of adaptation of the pupil")
        .check(one_of({"photopic", "mesopic", "scotopic"}))
        .shows_default();
    command.add_option("--eye-seed", a.eye_seed, "temporal, spencer: seed of the eye's needles and movements")
        .check(range(0u, 0xffffffffu))
        .shows_default();
    command.add_flag("--lashes", a.lashes, "temporal: the eye squints, and lashes hang before its pupil");
    command.help_group("Operators and their curves");
    command.add_option("--histogram-low", a.histogram_low, "Luminance the histogram begins with, cd/m^2")
        .check(between(1e-6, 1e9))
        .shows_default();
    command.add_option("--histogram-high", a.histogram_high, "Luminance the histogram ends with, cd/m^2")
        .check(between(1e-6, 1e9))
        .shows_default();
    a.tone.operators.each([&](auto& settings) { settings.options(OperatorOptions{command}); });
    command.help_group();
    add_display_options(command, a);
    command.help_group("Display");
    command
        .add_option(
            "--gamut", a.gamut,
            "Colours brighter than the display: luminance (keep its order, towards white), chromaticity (keep it, as "
            "bright as it can be) or clip (each channel by itself)")
        .check(one_of(gamut_names()))
        .shows_default();
    command.help_group();
}

render::ToneChainSettings tone_settings(const ToneArguments& arguments) {
    render::ToneChainSettings settings;
    const NamedGlare& glare = *std::find_if(std::begin(kGlares), std::end(kGlares),
                                            [&](const NamedGlare& one) { return arguments.glare == one.name; });
    settings.glare = glare.glare;
    settings.scatter = {glare.model,
                        {arguments.tone.observer.age, arguments.iris},
                        kPupils.at(arguments.pupil),
                        {arguments.eye_seed, arguments.lashes}};
    settings.histogram = arguments.histogram;
    settings.tone = arguments.tone;
    settings.tone.gamut = kGamuts.at(arguments.gamut);
    apply(arguments.eye, settings);
    settings.histogram.log10_low = float(std::log10(arguments.histogram_low));
    settings.histogram.log10_high = float(std::log10(arguments.histogram_high));
    if (!(arguments.histogram_high >= 1.01 * arguments.histogram_low))
        throw Error("--histogram-high must be more than --histogram-low");
    settings.tone.operators.check();
    if (settings.glare == Glare::Scatter && settings.tone_operator == render::Operator::Ldr)
        throw Error("--glare " + arguments.glare + ": the ldr operator has no luminances to scatter");
    settings.display = display_of(arguments);
    return settings;
}

const std::vector<std::string>& glare_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> made;
        for (const NamedGlare& glare : kGlares) made.emplace_back(glare.name);
        return made;
    }();
    return names;
}

const std::vector<std::string>& gamut_names() {
    static const std::vector<std::string> names{"luminance", "chromaticity", "clip"};
    return names;
}

std::string name_of(eye::ScatterSettings::Model wanted) {
    return std::find_if(std::begin(kGlares), std::end(kGlares),
                        [&](const NamedGlare& one) { return one.glare == Glare::Scatter && one.model == wanted; })
        ->name;
}

std::string name_of(render::Operator wanted) { return std::string(render::operator_info(wanted).name); }

std::string digits(double value) { return format("%.9g", value); }

io::Header describe_tone(const render::ToneChainSettings& settings, const render::ToneMapped& shown) {
    io::Header header{{"vesper:operator", name_of(settings.tone_operator)},
                      {"vesper:adaptationLuminance", digits(double(shown.curve.adaptation))},
                      {"vesper:eyeSeconds", digits(double(shown.eye.seconds))},
                      {"vesper:fovealLevel", std::to_string(shown.foveal_level)},
                      {"vesper:displayLow", digits(double(settings.display.low()))},
                      {"vesper:displayHigh", digits(double(settings.display.high()))},
                      {"vesper:coneSigma", digits(double(shown.curve.cone_sigma))},
                      {"vesper:rodSigma", digits(double(shown.curve.rod_sigma))}};
    for (const auto& [name, value] : named_state(shown.eye)) header.emplace_back("vesper:eye:" + name, digits(value));
    const auto list = [](const auto& values, size_t count) {
        std::string text;
        for (size_t i = 0; i < count; ++i) text += (i ? " " : "") + digits(double(values[i]));
        return text;
    };
    const std::vector<double> curve = curve_samples(shown.curve, settings.tone_operator, settings.display);
    header.emplace_back("vesper:eye:nodes",
                        list(shown.eye.node, shown.eye.steps > 0 ? size_t(shown.eye.steps) + 1 : 0));
    header.emplace_back("vesper:toneCurve",
                        "display cd/m^2 at 1e-4 to 1e6 cd/m^2 in tenths of a decade: " + list(curve, curve.size()));
    return header;
}

io::PngColour png_colour_of(const vision::Display& display) {
    io::PngColour colour;
    for (const auto& [primaries, code] :
         {std::pair(io::kRec709, 1), std::pair(io::kRec2020, 9), std::pair(io::kDisplayP3, 12)})
        if (display.primaries == primaries) colour.primaries = uint8_t(code);
    const bool square = display.eotf == vision::Eotf::Gamma && display.gamma == 2.2f;
    if (display.eotf == vision::Eotf::Pq) colour.transfer = 16;
    if (display.eotf == vision::Eotf::Srgb || (square && colour.primaries == io::kPngSrgb.primaries))
        colour.transfer = io::kPngSrgb.transfer;
    else if (square)
        colour.transfer = 4;
    return colour;
}

void write_codes(const std::string& file, const render::ToneMapped& shown, const vision::Display& display,
                 const io::Header& texts) {
    const auto [width, height] = shown.shown_extent;
    const io::PngColour colour = png_colour_of(display);
    if (display.bits == 8) return io::write_png(file, width, height, shown.display, colour, texts);
    std::vector<uint32_t> words(shown.display.size() / 4);
    std::memcpy(words.data(), shown.display.data(), words.size() * 4);
    io::write_png_10bit(file, width, height, words, colour, texts);
}

}  // namespace vesper::apps
