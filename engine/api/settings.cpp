// Settings of the tone chain as callers give them. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <string_view>

#include "api/handles.h"
#include "render/tone_rows.h"

namespace vesper::api {
namespace {

// Choices of the table are in the order of these.
static_assert(VESPER_GLARE_WARD == 5 && VESPER_ADAPT_TEXEL == 4 && VESPER_PUPIL_SCOTOPIC == 2 &&
              VESPER_GAMUT_CLIP == 2);

constexpr size_t kLongestOptions = 4096;  // characters

VesperToneSettings default_settings() {
    const render::ToneChainSettings settings;
    const render::ToneSettings& tone = settings.tone;
    const vision::Display& display = vision::known_displays().front().display;
    VesperToneSettings made{sizeof made};
    const auto choice = [&](const char* name) { return uint32_t(render::tone_row(name).get(settings)); };
    made.tone_operator = choice("operator"), made.glare = choice("glare"), made.bins = settings.histogram.bins;
    made.adapt_to = choice("adapt_to"), made.pupil = choice("pupil"), made.gamut = choice("gamut");
    made.age = float(tone.observer.age), made.pigmentation = float(settings.scatter.eye.pigmentation);
    made.gaze[0] = tone.gaze.x, made.gaze[1] = tone.gaze.y;
    made.display_peak = display.peak, made.display_black = display.black, made.display_ambient = display.ambient;
    made.display_gamma = display.gamma, made.display_reflection = display.reflection;
    made.smoothing = tone.smoothing_seconds, made.low_vision = float(tone.observer.low_vision),
    made.rods = tone.observer.use_rods;
    made.histogram_low = settings.histogram.low, made.histogram_high = settings.histogram.high;
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

// NAME=VALUE, separated by spaces. Numbers count as values of switches, too.
void read_options(std::string_view text, render::ToneChainSettings& settings) {
    while (!text.empty()) {
        const std::string_view word = text.substr(0, text.find(' '));
        text.remove_prefix(std::min(word.size() + 1, text.size()));
        if (word.empty()) continue;
        const size_t equals = std::min(word.find('='), word.size());
        const std::string_view value = word.substr(std::min(equals + 1, word.size()));
        require(equals > 0 && !value.empty(), "options are NAME=VALUE, separated by spaces");
        const render::ToneRow& row = render::tone_row(word.substr(0, equals));
        const bool is_switch = row.kind == render::SettingKind::Switch;
        row.set(settings, is_switch && value == "0" ? 0.0 : is_switch && value == "1" ? 1.0 : row.parse(value));
    }
}

// Of all but the display. Throws Error, too.
render::ToneChainSettings tone_of(const VesperToneSettings& s) {
    require(within(s.gaze[0], 0, 1) && within(s.gaze[1], 0, 1), "the gaze is a part of the image, 0 to 1");
    render::ToneChainSettings settings;
    const std::pair<const char*, double> given_values[]{
        {"operator", s.tone_operator},
        {"glare", s.glare},
        {"bins", s.bins},
        {"age", s.age},
        {"iris", s.pigmentation},
        {"colour_loss", s.colour_loss != 0},
        {"acuity_loss", s.acuity_loss != 0},
        {"purkinje", s.purkinje != 0},
        {"adapt_to", s.adapt_to},
        {"smoothing", s.smoothing},
        {"low_vision", s.low_vision},
        {"rods", s.rods != 0},
        {"histogram_low", s.histogram_low},
        {"histogram_high", s.histogram_high},
        {"key", s.key},
        {"white", s.white},
        {"linear_max", s.white},
        {"linear_min", s.black},
        {"pupil", s.pupil},
        {"eye_seed", s.eye_seed},
        {"lashes", s.lashes != 0},
        {"gamut", s.gamut},
    };
    for (const auto& [name, value] : given_values) {
        const render::ToneRow& row = render::tone_row(name);
        row.set(settings, row.checked(value));
    }
    settings.tone.gaze = {s.gaze[0], s.gaze[1]};
    if (s.options) {
        const size_t length = strnlen(s.options, kLongestOptions + 1);
        require(length <= kLongestOptions, "options are longer than 4096 characters");
        read_options({s.options, length}, settings);
    }
    require(settings.tone_operator != render::Operator::Ldr, "there is no such tone operator");
    render::check_tone(settings);
    return settings;
}

}  // namespace

render::RenderSettings settings_of(const VesperToneSettings* given, scene::DisplayFinder& displays) {
    const VesperToneSettings s = given ? known(given, "tone settings without their size") : default_settings();
    render::RenderSettings settings;
    static_cast<render::ToneChainSettings&>(settings) = accepted([&] { return tone_of(s); });
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
