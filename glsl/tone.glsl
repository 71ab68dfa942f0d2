// From scene luminance to displayed light, for bloom_bright.comp and composite.comp.

#include "shared/composite.h"
#include "shared/photometry.h"
#include "gamut.glsl"

const float kLeastRatio = 0.01;

layout(constant_id = 0) const uint kTone = kToneCurve;
const uint kForm = kTone & kToneForm;

struct Tone {
    float ln_low, bins_per_ln, bins;  // of the table
    vec4 block[kOperatorTexels];      // of the operator
};

Tone read_tone(samplerBuffer curve) {
    Tone tone;
    const vec4 table = texelFetch(curve, 0);
    tone.ln_low = table.r, tone.bins_per_ln = table.g, tone.bins = table.b;
    for (uint i = 0u; i < kOperatorTexels; ++i) tone.block[i] = texelFetch(curve, int(kToneBlock + i));
    return tone;
}

bool is_finite(float x) { return abs(x) <= 3.4e38; }

float luminance_of(vec3 rgb) { return dot(rgb, vec3(kRed, kGreen, kBlue)); }

// Scotopic luminance over that of white. Light outside of Rec. 709 counts as the nearest inside.
float scotopic_of(vec3 rgb) {
    if ((kTone & kTonePhotopicRods) != 0u) return luminance_of(rgb);
    rgb = max(rgb, vec3(0.0));
    const float x = dot(rgb, vec3(kXRed, kXGreen, kXBlue)), y = luminance_of(rgb), z = dot(rgb, vec3(kZRed, kZGreen, kZBlue));
    return y > 0.0 ? y * ((kScotopicSlope * (1.0 + (y + z) / x) - kScotopicOffset) / kScotopicOfWhite) : 0.0;
}

// Dim light loses its colour, or is weighted as rods do.
vec3 faded_when_dim(vec3 rgb) {
    if ((kTone & (kToneColourLoss | kTonePurkinje)) == 0u || kForm == kToneLdr) return rgb;
    const float luminance = luminance_of(rgb);
    if (!(luminance > 0.0)) return rgb;
    const float cones = clamp((luminance - kScotopicBelow) / (kPhotopicFrom - kScotopicBelow), 0.0, 1.0);
    const float grey = max((kTone & kTonePurkinje) != 0u ? scotopic_of(rgb) : luminance, 0.0);
    return (kTone & kToneColourLoss) != 0u ? mix(vec3(grey), rgb, cones) : rgb * (mix(grey, luminance, cones) / luminance);
}

// A node of the table, between its nodes.
vec4 node_at(samplerBuffer curve, Tone tone, float luminance) {
    const float at = clamp((log(max(luminance, kLuminanceFloor)) - tone.ln_low) * tone.bins_per_ln, 0.0, tone.bins);
    const float bin = min(floor(at), tone.bins - 1.0);
    return mix(texelFetch(curve, int(kToneNode0) + int(bin)), texelFetch(curve, int(kToneNode0) + int(bin) + 1), at - bin);
}

// What the operator makes of a pixel: displayed luminance, relative, 0 at the display's darkest and 1 at its brightest; and
// with kToneColour the exponent and the share of its colour.
struct Mapped {
    float luminance;
    float exponent, share;
};

#include "operators_pixels.glsl"

Mapped mapped(samplerBuffer curve, Tone tone, vec3 rgb, float display_low, float display_high) {
    const float luminance = max(luminance_of(rgb), 0.0);
    if (kMapsItself) return operator_mapped(curve, tone, rgb, luminance);
    return Mapped((exp(node_at(curve, tone, luminance).r) - display_low) / (display_high - display_low), 1.0, 1.0);
}

// A pixel as it is mapped: with the changes that the operator makes to its colour, cd/m^2, and dim light without its colour; of
// operators that map colours, not luminance, the light that they show, 1 for white.
vec3 perceived(Tone tone, vec3 rgb) {
    rgb = operator_seen(tone, rgb);
    return operator_rgb(tone, faded_when_dim(rgb));
}

// Ratios of a colour to its luminance, raised to the power and mixed with grey.
vec3 faded(vec3 ratios, Mapped to) {
    // A channel with less light than kLeastRatio, or negative light, gets that from the others: powers are steep near 0, and a colour that
    // leaves the primaries would have an edge there. In the dark, where exponents go to 0, it goes grey with the others.
    const float least = min(ratios.r, min(ratios.g, ratios.b));
    if (least < kLeastRatio) ratios = max(1.0 + (ratios - 1.0) * ((1.0 - kLeastRatio) / (1.0 - least)), vec3(kLeastRatio));
    return mix(vec3(1.0), pow(ratios, vec3(to.exponent)), to.share);
}

// Light that a pixel asks of the display, in its primaries.
struct Asked {
    vec3 light;
    float luminance;  // of it, displayed
    bool shown;       // it is as it is displayed, in [0, 1]
};

// `own` is the colour of the pixel in the display's primaries. Pixels that are not finite are black; those without luminance are shown as
// what has hardly any.
Asked asked(samplerBuffer curve, Tone tone, vec3 rgb, vec3 own, float display_low, float display_high) {
    if (kForm == kToneLdr)
        return Asked(is_finite(rgb.r) && is_finite(rgb.g) && is_finite(rgb.b) ? clamp(own, 0.0, 1.0) : vec3(0.0), 0.0, true);
    const float luminance = luminance_of(rgb);
    if (!is_finite(luminance)) return Asked(vec3(0.0), 0.0, true);
    const Mapped to = mapped(curve, tone, rgb, display_low, display_high);
    const float d = clamp(to.luminance, 0.0, 1.0);
    if (luminance <= 0.0) return Asked(vec3(d), d, true);
    return Asked(kForm == kToneColour ? faded(own / luminance, to) * d : own * (d / luminance), d, false);
}

// Displayed light of a pixel, RGB in [0, 1], in the primaries of `gamut`.
vec3 displayed(samplerBuffer curve, Tone tone, vec3 rgb, vec3 own, Gamut gamut, float display_low, float display_high) {
    const Asked of = asked(curve, tone, rgb, own, display_low, display_high);
    return of.shown ? of.light : in_gamut(gamut, kTone, of.light, of.luminance);
}

// The same in Rec. 709, whatever the display's limits.
vec3 displayed_unbounded(samplerBuffer curve, Tone tone, vec3 rgb, float display_low, float display_high) {
    if (kForm == kToneLdr) return displayed(curve, tone, rgb, rgb, rec709_gamut(), display_low, display_high);
    const float luminance = luminance_of(rgb);
    if (!is_finite(luminance)) return vec3(0.0);
    const Mapped to = mapped(curve, tone, rgb, display_low, display_high);
    const float d = max(to.luminance, 0.0);
    if (luminance <= 0.0) return vec3(d);
    return kForm == kToneColour ? faded(rgb / luminance, to) * d : rgb * (d / luminance);
}
