#include "render/tone_rows.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/error.h"

namespace vesper::render {
namespace {

constexpr std::string_view kFirstPage, kCurve = "Operators and their curves", kEye = "The eye", kGlare = "Glare",
                                       kDisplay = "Display";

template <class Member>
ToneRow row_of(const Setting& row, Member member) {
    return setting_of<ToneChainSettings>(row, member);
}

using Get = std::function<double(const ToneChainSettings&)>;
using Set = std::function<void(ToneChainSettings&, double)>;
ToneRow row_of(Setting row, SettingKind kind, Get get, Set set) {
    row.kind = kind;
    row.values.fill(get({}));
    return {row, std::move(get), std::move(set)};
}

// `get` and `set` are of the index of a choice.
ToneRow choice(Setting row, std::span<const std::string_view> choices, Get get, Set set) {
    row.choices = choices, row.low = 0, row.high = double(choices.size()) - 1;
    return row_of(row, SettingKind::Choice, std::move(get), std::move(set));
}

struct NamedGlare {
    Glare glare;
    eye::ScatterSettings::Model model;
};
using Model = eye::ScatterSettings::Model;
constexpr std::array<std::string_view, 6> kGlareNames{"none", "cie", "ldr", "temporal", "spencer", "ward"};
constexpr std::array<NamedGlare, 6> kGlares{{{Glare::None, Model::Cie},
                                             {Glare::Scatter, Model::Cie},
                                             {Glare::Ldr, Model::Cie},
                                             {Glare::Scatter, Model::Temporal},
                                             {Glare::Scatter, Model::Spencer},
                                             {Glare::Scatter, Model::Ward}}};

ToneRow glare_row() {
    return choice(
        {"glare", "",
         "Light scattered in the eye\n"
         "  cie: CIE 135/1 total glare function\n"
         "  ldr: the paper's, on the tone-mapped image; the others are in cd/m^2 before the operator\n"
         "  temporal: cie with needles and halo that move, after Ritschel 2009\n"
         "  spencer: 1995, with needles and halo\n"
         "  ward: the veil of 1997",
         kFirstPage},
        kGlareNames,
        [](const ToneChainSettings& s) {
            const auto found = std::ranges::find_if(kGlares, [&](const NamedGlare& one) {
                return one.glare == s.glare && (one.glare != Glare::Scatter || one.model == s.scatter.model);
            });
            return double(found - kGlares.begin());
        },
        [](ToneChainSettings& s, double value) {
            const NamedGlare& one = kGlares[size_t(value)];
            s.glare = one.glare;
            if (one.glare == Glare::Scatter) s.scatter.model = one.model;
        });
}

std::vector<std::string_view> operator_names() {
    std::vector<std::string_view> names;
    for (const OperatorInfo& op : operators()) names.push_back(op.name);
    return names;
}

std::string operator_help() {
    std::string help = "How luminance is shown";
    for (const OperatorInfo& op : operators()) help += "\n  " + std::string(op.name) + ": " + std::string(op.summary);
    return help;
}

ToneRow operator_row() {
    static const std::vector<std::string_view> kNames = operator_names();
    static const std::string kHelp = operator_help();
    return choice(
        {"operator", "", kHelp, kFirstPage}, kNames, [](const ToneChainSettings& s) { return double(s.tone_operator); },
        [](ToneChainSettings& s, double value) { s.tone_operator = Operator(int(value)); });
}

/// A choice of codes that an operator has a default of: "operator" is its first name.
template <size_t n>
ToneRow code_row(const Setting& row, const std::array<std::string_view, n + 1>& names,
                 const std::array<uint32_t, n>& codes, std::optional<uint32_t> ToneSettings::*code) {
    return choice(
        row, names,
        [codes, code](const ToneChainSettings& s) {
            const auto found = std::ranges::find(codes, (s.tone.*code).value_or(~0u));
            return found == codes.end() ? 0.0 : double(found - codes.begin() + 1);
        },
        [codes, code](ToneChainSettings& s, double value) {
            if (value == 0)
                (s.tone.*code).reset();
            else
                s.tone.*code = codes[size_t(value) - 1];
        });
}

ToneRow adapt_to_row() {
    static constexpr std::array<std::string_view, 5> kNames{"operator", "average", "gaze", "gaze-mean", "texel"};
    return code_row<4>({"adapt_to", "",
                        "What the eye adapts to: log average of the frame, log average or mean about the gaze, one "
                        "texel; or as the operator has it",
                        kEye},
                       kNames, {shared::kAdaptAverage, shared::kAdaptGaze, shared::kAdaptGazeMean, shared::kAdaptTexel},
                       &ToneSettings::adapt_to);
}

ToneRow ceiling_row() {
    static constexpr std::array<std::string_view, 5> kNames{"operator", "eye", "human", "cones", "linear"};
    return code_row<4>({"ceiling", "",
                        "irawan, ward: thresholds that bound contrast: of the eye in its state, adapted human, adapted "
                        "cones, or none (linear); or as the operator has it",
                        kCurve},
                       kNames,
                       {shared::kCeilingEye, shared::kCeilingHuman, shared::kCeilingCones, shared::kCeilingLinear},
                       &ToneSettings::ceiling);
}

ToneRow pupil_row() {
    static constexpr std::array<std::string_view, 3> kNames{"photopic", "mesopic", "scotopic"};
    return choice(
        {"pupil", "", "spencer: state of adaptation of the pupil", kGlare}, kNames,
        [](const ToneChainSettings& s) { return double(s.scatter.state); },
        [](ToneChainSettings& s, double value) { s.scatter.state = vision::SpencerState(int(value)); });
}

ToneRow gamut_row() {
    static constexpr std::array<std::string_view, 3> kNames{"luminance", "chromaticity", "clip"};
    static constexpr std::array<uint32_t, 3> kCodes{shared::kGamutLuminance, shared::kGamutChromaticity,
                                                    shared::kGamutClip};
    return choice(
        {"gamut", "",
         "Colours brighter than the display: luminance (keep its order, towards white), chromaticity (keep it, as "
         "bright as it can be) or clip (each channel by itself)",
         kDisplay},
        kNames,
        [](const ToneChainSettings& s) { return double(std::ranges::find(kCodes, s.tone.gamut) - kCodes.begin()); },
        [](ToneChainSettings& s, double value) { s.tone.gamut = kCodes[size_t(value)]; });
}

// Age counts in the thresholds of the observer and in the scatter of the same eye.
ToneRow age_row() {
    ToneRow row = row_of(
        {"age", "years", "Age of the observer", kFirstPage, 1, 120},
        [](auto& s) -> auto& { return s.tone.observer.age; });
    row.set = [](ToneChainSettings& s, double value) { s.tone.observer.age = s.scatter.eye.age = value; };
    return row;
}

ToneRow foveal_level_row() {
    return row_of(
        {"foveal_level", "", "Pyramid level of the histogram (the paper: 5); 0: 1 degree per texel", kCurve, 0, 14},
        SettingKind::Count, [](const ToneChainSettings& s) { return double(s.foveal_level.value_or(0)); },
        [](ToneChainSettings& s, double value) {
            s.foveal_level = value > 0 ? std::optional(uint32_t(value)) : std::nullopt;
        });
}

ToneRow whole_votes_row() {
    return row_of(
        {"whole_votes", "", "Histogram: whole votes of the foveal level alone", kCurve}, SettingKind::Switch,
        [](const ToneChainSettings& s) { return double(!s.histogram.split); },
        [](ToneChainSettings& s, double value) {
            s.histogram.split = s.histogram.fine = s.histogram.overlap = value == 0;
        });
}

void add_curve(std::vector<ToneRow>& rows) {
    rows.push_back(operator_row());
    rows.push_back(row_of(
        {"bins", "", "Bins of the histogram", kCurve, 1, shared::kMaxBins},
        [](auto& s) -> auto& { return s.histogram.bins; }));
    rows.push_back(foveal_level_row());
    rows.push_back(whole_votes_row());
    rows.push_back(row_of(
        {"smoothing", "s", "Curve: time constant against flicker; no model of the eye; 0: none", kCurve, 0, 60},
        [](auto& s) -> auto& { return s.tone.smoothing_seconds; }));
    rows.push_back(ceiling_row());
    rows.push_back(row_of(
        {"histogram_low", "cd/m^2", "Luminance the histogram begins with", kCurve, 1e-6, 1e9},
        [](auto& s) -> auto& { return s.histogram.low; }));
    rows.push_back(row_of(
        {"histogram_high", "cd/m^2", "Luminance the histogram ends with", kCurve, 1e-6, 1e9},
        [](auto& s) -> auto& { return s.histogram.high; }));
    OperatorSettings::each([&](auto of) {
        using Own = std::remove_reference_t<decltype(std::declval<OperatorSettings&>().*of)>;
        Own::options([&](auto member, const OperatorOption& option) {
            rows.push_back(row_of(
                {option.name, option.unit, option.help, kCurve, option.low, option.high},
                [ of, member ](auto& s) -> auto& { return s.tone.operators.*of.*member; }));
        });
    });
}

void add_eye(std::vector<ToneRow>& rows) {
    const auto add = [&](const Setting& row, auto member) { rows.push_back(row_of(row, member)); };
    rows.push_back(adapt_to_row());
    add(
        {"colour_loss", "", "Dim light loses its colour (from 5.62 down to 0.00562 cd/m^2)", kEye},
        [](auto& s) -> auto& { return s.tone.colour_loss; });
    add(
        {"acuity_loss", "", "Dim light is blurred as far as it cannot be resolved", kEye},
        [](auto& s) -> auto& { return s.tone.acuity_loss; });
    add(
        {"purkinje", "", "Dim light is weighted as rods do: blue brighter, red darker", kEye},
        [](auto& s) -> auto& { return s.tone.purkinje; });
    add(
        {"photopic_rods", "", "Rods take luminance for scotopic luminance (as pfstools); off: that of the colour",
         kEye},
        [](auto& s) -> auto& { return s.tone.photopic_rods; });
    rows.push_back(age_row());
    add(
        {"low_vision", "", "Observer: factor of all thresholds", kEye, 0.1, 100},
        [](auto& s) -> auto& { return s.tone.observer.low_vision; });
    add(
        {"rods", "", "Observer: rods see too, not only cones", kEye},
        [](auto& s) -> auto& { return s.tone.observer.use_rods; });
    add(
        {"semi_saturation", "", "Observer: c, half saturation over luminance in daylight", kEye, 1, 100},
        [](auto& s) -> auto& { return s.tone.observer.cones.semi_saturation; });
    add(
        {"fast_seconds", "s", "Observer: fast neural adaptation of cones, time constant", kEye, 1e-3, 10},
        [](auto& s) -> auto& { return s.tone.observer.cones.fast_seconds; });
    add(
        {"slow_seconds", "s", "Observer: slow neural adaptation of cones, time constant", kEye, 1e-3, 1e4},
        [](auto& s) -> auto& { return s.tone.observer.cones.slow_seconds; });
    add(
        {"fast_share", "", "Observer: part of the neural adaptation of cones that is fast", kEye, 0, 1},
        [](auto& s) -> auto& { return s.tone.observer.cones.fast_share; });
    add(
        {"bleach_seconds", "s", "Observer: pigment of cones, time constant", kEye, 1e-3, 1e5},
        [](auto& s) -> auto& { return s.tone.observer.cones.bleach_seconds; });
    add(
        {"bleach_trolands", "td", "Observer: what bleaches half of the pigment of cones", kEye, 1, 1e9},
        [](auto& s) -> auto& { return s.tone.observer.cones.bleach_trolands; });
}

void add_glare(std::vector<ToneRow>& rows) {
    rows.push_back(glare_row());
    rows.push_back(row_of(
        {"iris", "", "cie, temporal: pigmentation of the iris: 0 very dark, 0.5 brown, 1 green, 1.2 light blue", kGlare,
         0, 1.5},
        [](auto& s) -> auto& { return s.scatter.eye.pigmentation; }));
    rows.push_back(pupil_row());
    rows.push_back(row_of(
        {"eye_seed", "", "temporal, spencer: seed of the eye's needles and movements", kGlare, 0, 0xffffffffu},
        [](auto& s) -> auto& { return s.scatter.aperture.seed; }));
    rows.push_back(row_of(
        {"lashes", "", "temporal: the eye squints, and lashes hang before its pupil", kGlare},
        [](auto& s) -> auto& { return s.scatter.aperture.lashes; }));
}

}  // namespace

std::span<const ToneRow> tone_rows() {
    static const std::vector<ToneRow> kRows = [] {
        std::vector<ToneRow> rows;
        add_curve(rows);
        add_eye(rows);
        add_glare(rows);
        rows.push_back(gamut_row());
        return rows;
    }();
    return kRows;
}

const ToneRow& tone_row(std::string_view name) { return row_named(tone_rows(), name); }

void check_tone(const ToneChainSettings& settings) {
    if (!(settings.histogram.high >= 1.01f * settings.histogram.low))
        throw Error("--histogram-high must be more than --histogram-low");
    settings.tone.operators.check();
    if (settings.glare == Glare::Scatter && settings.tone_operator == Operator::Ldr)
        throw Error("--glare " + tone_row("glare").text(tone_row("glare").get(settings)) +
                    ": the ldr operator has no luminances to scatter");
}

}  // namespace vesper::render
