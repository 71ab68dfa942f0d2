// Settings of the tone chain as callers give them. SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cstring>
#include <string_view>

#include "api/handles.h"

namespace vesper::api {
namespace {

struct Scattering {
    VesperGlare glare;
    eye::ScatterSettings::Model model;
};
constexpr Scattering kScatterings[] = {{VESPER_GLARE_CIE, eye::ScatterSettings::Model::Cie},
                                       {VESPER_GLARE_TEMPORAL, eye::ScatterSettings::Model::Temporal},
                                       {VESPER_GLARE_SPENCER, eye::ScatterSettings::Model::Spencer},
                                       {VESPER_GLARE_WARD, eye::ScatterSettings::Model::Ward}};
constexpr uint32_t kAdaptTo[] = {shared::kAdaptAverage, shared::kAdaptGaze, shared::kAdaptGazeMean,
                                 shared::kAdaptTexel};  // from VESPER_ADAPT_AVERAGE on
constexpr uint32_t kGamuts[] = {shared::kGamutLuminance, shared::kGamutChromaticity,
                                shared::kGamutClip};  // by VesperGamut
static_assert(VESPER_PUPIL_MESOPIC == int(vision::SpencerState::Mesopic) &&
              VESPER_PUPIL_SCOTOPIC == int(vision::SpencerState::Scotopic));

constexpr size_t kLongestOptions = 4096;  // characters that are read

VesperToneSettings default_settings() {
    const render::ToneChainSettings settings;
    const render::ToneSettings& tone = settings.tone;
    const vision::Display& display = vision::known_displays().front().display;
    VesperToneSettings made{sizeof made};
    made.tone_operator = VESPER_IRAWAN, made.glare = VESPER_GLARE_NONE, made.bins = settings.histogram.bins;
    made.age = float(tone.observer.age), made.pigmentation = float(settings.scatter.eye.pigmentation);
    made.gaze[0] = tone.gaze.x, made.gaze[1] = tone.gaze.y;
    made.display_peak = display.peak, made.display_black = display.black, made.display_ambient = display.ambient;
    made.display_gamma = display.gamma, made.display_reflection = display.reflection;
    made.smoothing = tone.smoothing_seconds, made.low_vision = float(tone.observer.low_vision),
    made.rods = tone.observer.use_rods;
    made.histogram_low = std::pow(10.0f, settings.histogram.log10_low),
    made.histogram_high = std::pow(10.0f, settings.histogram.log10_high);
    made.key = tone.operators.reinhard.key, made.eye_seed = settings.scatter.aperture.seed;
    return made;
}

vision::Display display_of(const VesperToneSettings& s, scene::DisplayFinder& displays) {
    if (s.display) return displays.find(s.display);
    vision::Display display = vision::known_displays().front().display;
    display.peak = s.display_peak, display.black = s.display_black, display.ambient = s.display_ambient;
    display.gamma = s.display_gamma, display.reflection = s.display_reflection;
    return display;
}

// Sets an option of an operator by its name on the command line, without dashes.
struct NamedOption {
    std::string_view name;
    double value;
    bool& found;

    void operator()(const render::OperatorOption& option, float& setting) const {
        if (!is(option)) return;
        require(value >= option.low && value <= option.high, "an option of an operator is out of its range");
        setting = float(value);
    }
    void operator()(const render::OperatorOption& option, bool& setting) const {
        if (!is(option)) return;
        require(value == 0 || value == 1, "an option of an operator is a flag: 0 or 1");
        setting = value == 1;
    }

private:
    bool is(const render::OperatorOption& option) const {
        const bool same = std::string_view(option.name).substr(2) == name;
        found = found || same;
        return same;
    }
};

// NAME=NUMBER, separated by spaces.
void read_options(std::string_view text, render::ToneSettings& tone) {
    while (!text.empty()) {
        const std::string_view word = text.substr(0, text.find(' '));
        text.remove_prefix(std::min(word.size() + 1, text.size()));
        if (word.empty()) continue;
        const size_t equals = word.find('=');
        double value = 0;
        const bool whole = equals != word.npos &&
                           std::from_chars(word.data() + equals + 1, word.data() + word.size(), value).ptr ==
                               word.data() + word.size() &&
                           equals + 1 < word.size();
        require(whole, "options of operators are NAME=NUMBER, separated by spaces");
        bool found = false;
        tone.operators.each([&](auto& settings) {
            settings.options(NamedOption{word.substr(0, equals), value, found});
        });
        require(found, "there is no such option of an operator");
    }
    tone.operators.check();
}

}  // namespace

render::RenderSettings settings_of(const VesperToneSettings* given, scene::DisplayFinder& displays) {
    const VesperToneSettings s = given ? known(given, "tone settings without their size") : default_settings();
    const auto is_operator = [&](const render::OperatorInfo& info) {
        return info.tone_operator != render::Operator::Ldr && uint32_t(info.tone_operator) == s.tone_operator;
    };
    require(s.gamut <= VESPER_GAMUT_CLIP, "there is no such gamut");
    require(std::ranges::any_of(render::operators(), is_operator), "there is no such tone operator");
    require(s.glare <= VESPER_GLARE_WARD, "there is no such glare");
    require(s.bins >= 1 && s.bins <= shared::kMaxBins, "a histogram has 1 to 256 bins");
    require(within(s.age, 1, 120) && within(s.pigmentation, 0, 1.5f),
            "an observer is 1 to 120 years old, with a pigmentation of 0 to 1.5");
    require(within(s.gaze[0], 0, 1) && within(s.gaze[1], 0, 1), "the gaze is a part of the image, 0 to 1");
    require(s.adapt_to <= VESPER_ADAPT_TEXEL, "adapt_to is not a VesperAdaptTo");
    require(s.pupil <= VESPER_PUPIL_SCOTOPIC, "there is no such pupil");
    require(within(s.smoothing, 0, 60) && within(s.low_vision, 0.1f, 100),
            "a curve is smoothed over 0 to 60 s, and low vision is a factor of 0.1 to 100");
    require(within(s.histogram_low, 1e-6f, 1e9f) && within(s.histogram_high, 1.01f * s.histogram_low, 1e9f),
            "a histogram begins at 1e-6 cd/m^2 or more and ends higher, at 1e9 or less");
    require(within(s.key, 1e-4f, 10) && within(s.white, 0, 1e9f) && within(s.black, 0, 1e9f),
            "a key is 1e-4 to 10, and luminances shown as white and black are 0 to 1e9 cd/m^2");
    require(s.white == 0 || s.white > s.black, "white is more than black");
    render::RenderSettings settings;
    settings.tone_operator = render::Operator(s.tone_operator);
    settings.glare = s.glare == VESPER_GLARE_NONE  ? render::Glare::None
                     : s.glare == VESPER_GLARE_LDR ? render::Glare::Ldr
                                                   : render::Glare::Scatter;
    for (const Scattering& one : kScatterings)
        if (one.glare == VesperGlare(s.glare)) settings.scatter.model = one.model;
    settings.scatter.eye = {double(s.age), double(s.pigmentation)};
    settings.scatter.state = vision::SpencerState(s.pupil);
    settings.scatter.aperture = {s.eye_seed, s.lashes != 0};
    settings.histogram.bins = s.bins;
    settings.histogram.log10_low = std::log10(s.histogram_low),
    settings.histogram.log10_high = std::log10(s.histogram_high);
    render::ToneSettings& tone = settings.tone;
    tone.observer.age = s.age, tone.observer.low_vision = s.low_vision, tone.observer.use_rods = s.rods;
    tone.gaze = {s.gaze[0], s.gaze[1]};
    tone.colour_loss = s.colour_loss, tone.acuity_loss = s.acuity_loss, tone.purkinje = s.purkinje;
    tone.smoothing_seconds = s.smoothing;
    tone.gamut = kGamuts[s.gamut];
    tone.operators.reinhard.key = s.key, tone.operators.reinhard.white = tone.operators.linear.high = s.white;
    tone.operators.linear.low = s.black;
    if (s.options) read_options(std::string_view(s.options, strnlen(s.options, kLongestOptions)), tone);
    if (s.adapt_to != VESPER_ADAPT_AS_OPERATOR) tone.adapt_to = kAdaptTo[s.adapt_to - VESPER_ADAPT_AVERAGE];
    settings.display = display_of(s, displays);
    vision::check_display(settings.display);
    return settings;
}

extern "C" {

VesperResult vesper_display_bits(const char* display, uint32_t* bits, VesperError* error) {
    return guarded(error, [&] {
        require(display && bits, "the display, or the pointer to its bits, is null");
        *bits = uint32_t(scene::find_display(display).bits);
    });
}

void vesper_tone_settings_defaults(VesperToneSettings* settings, size_t size) {
    if (!settings || size < sizeof settings->size) return;
    VesperToneSettings made = default_settings();
    made.size = uint32_t(std::min(size, sizeof made));
    std::memcpy(settings, &made, made.size);
}

}  // extern "C"

}  // namespace vesper::api
