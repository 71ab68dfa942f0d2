// The settings of a frame's light: one row each. SPDX-License-Identifier: MIT
//
// A row is X(type, name, unit, low, high, fast, interactive, standard, exact, help). From it come the member of
// LightSettings with its default (standard), the command-line option (--name, dashes for underscores), the setting of
// vesper-drive, its switch there, vesper_set() and vesper_get(), the fields of pictures and of JSON, and the table in
// docs/quality.md. fast, interactive, standard and exact are the values in the sets of --quality: settings that trade
// truth for time differ there.
#pragma once

#include <cstdint>

#include "render/setting.h"

namespace vesper::render {

// clang-format off
#define VESPER_LIGHT_SETTINGS(X) \
    X(bool, shadows, "", 0, 1, true, true, true, true, "Lamps light only surfaces that they see; off: they shine through everything") \
    X(double, shadow_resolution, "", 0.25, 4, 0.5, 1, 1, 1, "Side of shadow maps of lamps, as a factor; where maps would be larger than --shadow-memory they stay smaller") \
    X(uint32_t, shadow_memory, "MiB", 64, 1024, 192, 192, 192, 192, "Device memory of shadow maps of lamps and of what draws them, at most: sides are chosen to fit") \
    X(double, caster_error, "texels", 0, 1, 1, 1, 0.25, 0, "Error of what stands still in shadow maps of lamps that move, beyond 4 m; 0: nothing is simplified") \
    X(float, unshadowed_share, "", 0, 1, 0.01, 0.005, 0.001, 0, "Share of the light of the picture that lamps may give together which move and cast no shadows: the faintest") \
    X(float, shadow_error, "", 0, 1, 0.02, 0.02, 0.005, 0, "Share of the light of 8x8 pixels: shadows of lamps that give less are means over these pixels") \
    X(float, threshold, "lx", 1e-9, 1e3, 0.01, 0.005, 0.001, 1e-9, "Illuminance below which a lamp counts as dark: on matt surfaces, or on a plane facing it") \
    X(float, merge_error, "", 0, 1, 0.01, 0.01, 0.001, 0, "Relative error of a lamp whose light is taken as smooth over 8x8 pixels; 0: no lamp is") \
    X(float, probe_error, "", 0, 100, 100, 0, 0, 0, "Share of the light of 8x8 pixels: of lamps that give less all see what 16 of them see where these agree, on bent surfaces too") \
    X(bool, all_lamps, "", 0, 1, false, false, false, false, "Every lamp above the threshold is evaluated in every pixel: slow, for comparison") \
    X(bool, indirect, "", 0, 1, true, true, true, true, "Light of emitting surfaces and of the sky, and reflected light, on surfaces at rest; off: a constant in its place") \
    X(uint32_t, reflections, "", 0, 100, 100, 100, 100, 100, "Reflections of indirect light, at most") \
    X(double, reflection_error, "", 0, 1, 0.05, 0.01, 0.002, 0, "Share of the indirect light: reflections end where the rest would add less") \
    X(bool, moving_reflections, "", 0, 1, false, false, false, false, "Road and walls reflect light of lamps that move, such as headlamps, once: an estimate") \
    X(bool, anti_aliasing, "", 0, 1, false, true, true, true, "Pixels at edges show the mean luminance of the surfaces that fill them; off: the luminance of one") \
    X(uint32_t, edge_points, "", 4, 16, 8, 16, 16, 16, "Points of a pixel at an edge, by which the surfaces that fill it have their shares") \
    X(uint32_t, samples, "", 1, 65536, 1, 1, 1, 1, "Points of each pixel whose luminance is averaged, before one glare and one eye; 64 make a reference") \
    X(bool, display_average, "", 0, 1, false, false, false, false, "With samples, codes are the mean of the displayed light of each sample; off: the displayed mean luminance") \
    X(bool, paper_lambert, "", 0, 1, false, false, false, false, "L = E R, as the paper has it; off: L = E R / pi") \
    X(double, scale, "", 0.25, 1, 0.5, 1, 1, 1, "Part of the pixels of each side that is rendered; the displayed picture is enlarged to the size asked for")
// clang-format on

struct LightSettings {
#define VESPER_MEMBER(type, name, unit, low, high, fast, interactive, standard, exact, help) \
    type name = static_cast<type>(standard);
    VESPER_LIGHT_SETTINGS(VESPER_MEMBER)
#undef VESPER_MEMBER
};

}  // namespace vesper::render
