#include "arguments/tone_arguments.h"

#include <algorithm>
#include <cstring>

#include "arguments/setting_arguments.h"
#include "base/error.h"
#include "print.h"
#include "tone_log.h"

namespace vesper::apps {
namespace {

/// Petit, Bremond and Vienne: what --preset paper is, unless an option says otherwise.
constexpr std::pair<const char*, const char*> kPaper[]{{"operator", "irawan"}, {"bins", "100"},
                                                       {"foveal-level", "5"},  {"whole-votes", "on"},
                                                       {"smoothing", "0"},     {"adapt-to", "texel"}};

void set(render::ToneChainSettings& settings, std::string_view name, const std::string& text) {
    const render::ToneRow& row = render::tone_row(name);
    row.set(settings, row.parse(text));
}

}  // namespace

void add_tone_options(Command command, ToneArguments& a) {
    a.command = command;
    for (const render::ToneRow& row : render::tone_rows()) add_row_option(command, row, row.get(a.own));
    command.help_group("The eye");
    command.add_option("--gaze", a.gaze, "Where the eye looks: X,Y, parts of the image from its top left")
        .separated_by(',')
        .values(2)
        .check(between(0.0, 1.0));
    command.help_group("Operators and their curves");
    command
        .add_option("--preset", a.preset,
                    "paper: irawan with cones only, 100 bins, whole votes of level 5 alone, adapted to its texel at "
                    "the gaze, no smoothing (at its 1680x1050, the default size)")
        .check(one_of({"none", "paper"}))
        .shows_default();
    command.help_group();
    add_display_options(command, a);
}

render::ToneChainSettings tone_settings(const ToneArguments& a) {
    render::ToneChainSettings settings = a.own;
    if (a.preset == "paper")
        for (const auto& [name, text] : kPaper) set(settings, name, text);
    for (const render::ToneRow& row : render::tone_rows()) {
        const std::string option = "--" + row.option();
        if (const auto found = a.instead.find(row.name); found != a.instead.end())
            set(settings, row.name, found->second);
        else if (a.command.count(option))
            set(settings, row.name, a.command.option(option).results().back());
    }
    settings.tone.gaze = {a.gaze.at(0), a.gaze.at(1)};
    render::check_tone(settings);
    settings.display = display_of(a);
    return settings;
}

std::string text_of(std::string_view name, const render::ToneChainSettings& settings) {
    const render::ToneRow& row = render::tone_row(name);
    return row.text(row.get(settings));
}

std::string name_of(render::Operator wanted) { return std::string(render::operator_info(wanted).name); }

std::string digits(double value) { return format("%.9g", value); }

io::Header describe_tone(const render::ToneChainSettings& settings) {
    io::Header header;
    for (const render::ToneRow& row : render::tone_rows())
        header.emplace_back("vesper:" + field_of(row), row.text(row.get(settings)));
    return header;
}

io::Header describe_codes(const std::string& quality, const render::RenderSettings& settings) {
    io::Header header = describe_settings(recorded_settings(quality, settings));
    const io::Header tone = describe_tone(settings);
    header.insert(header.end(), tone.begin(), tone.end());
    return header;
}

std::string tone_json(const render::ToneChainSettings& settings) {
    std::string members;
    for (const render::ToneRow& row : render::tone_rows())
        members += (members.empty() ? "" : ", ") + json_member(row, row.get(settings));
    return members;
}

io::Header describe_tone(const render::ToneChainSettings& settings, const render::ToneMapped& shown) {
    io::Header header = describe_tone(settings);
    header.insert(header.end(), {{"vesper:adaptationLuminance", digits(double(shown.curve.adaptation))},
                                 {"vesper:eyeSeconds", digits(double(shown.eye.seconds))},
                                 {"vesper:shownFovealLevel", std::to_string(shown.foveal_level)},
                                 {"vesper:displayLow", digits(double(settings.display.low()))},
                                 {"vesper:displayHigh", digits(double(settings.display.high()))},
                                 {"vesper:coneSigma", digits(double(shown.curve.cone_sigma))},
                                 {"vesper:rodSigma", digits(double(shown.curve.rod_sigma))}});
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
