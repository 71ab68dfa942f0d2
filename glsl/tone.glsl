// From scene luminance to displayed light, for bright.comp and composite.comp.

#include "shared/composite.h"
#include "shared/photometry.h"

const float kLeastRatio = 1e-6;

layout(constant_id = 0) const uint kTone = kToneCurve;
const uint kForm = kTone & kToneForm;

struct Tone {
    float scale, white;          // Reinhard
    float low, gain;             // linear
    float ln_low, bins_per_ln;   // curve
    float bins;
    vec3 rods;                   // rods
};

Tone read_tone(samplerBuffer curve) {
    const vec4 a = texelFetch(curve, 0), b = texelFetch(curve, 1);
    const vec3 rods = kForm == kToneRods ? texelFetch(curve, 4).rgb : vec3(0.0);
    return Tone(a.r, a.g, a.b, a.a, b.r, b.g, b.b, rods);
}

float luminance_of(vec3 rgb) { return dot(rgb, vec3(kRed, kGreen, kBlue)); }

float scotopic_of(vec3 rgb) { return dot(rgb, vec3(kScotopicRed, kScotopicGreen, kScotopicBlue)); }

// What is seen of a pixel, cd/m^2, before it is mapped: rods add grey, or dim light loses its colour.
vec3 perceived(Tone tone, vec3 rgb) {
    if (kForm == kToneRods) rgb += scotopic_of(rgb) * tone.rods;
    if ((kTone & (kToneColourLoss | kTonePurkinje)) == 0u || kForm == kToneLdr) return rgb;
    const float luminance = luminance_of(rgb);
    if (!(luminance > 0.0)) return rgb;
    const float cones = clamp((luminance - kScotopicBelow) / (kPhotopicFrom - kScotopicBelow), 0.0, 1.0);
    const float grey = max((kTone & kTonePurkinje) != 0u ? scotopic_of(rgb) : luminance, 0.0);
    return (kTone & kToneColourLoss) != 0u ? mix(vec3(grey), rgb, cones) : rgb * (mix(grey, luminance, cones) / luminance);
}

// Displayed luminance, relative: 0 at the display's darkest, 1 at its brightest.
float displayed_luminance(samplerBuffer curve, Tone tone, float luminance, float display_low, float display_high) {
    if (kForm == kToneReinhard) {
        const float x = tone.scale * luminance;
        return x * (1.0 + x * tone.white) / (1.0 + x);
    }
    if (kForm == kToneLinear || kForm == kToneRods) return (luminance - tone.low) * tone.gain;
    const float at = clamp((log(max(luminance, kLuminanceFloor)) - tone.ln_low) * tone.bins_per_ln, 0.0, tone.bins);
    const float bin = min(floor(at), tone.bins - 1.0);
    const float below = texelFetch(curve, int(kToneNode0) + int(bin)).r;
    const float above = texelFetch(curve, int(kToneNode0) + int(bin) + 1).r;
    return (exp(mix(below, above, at - bin)) - display_low) / (display_high - display_low);
}

// Ratios of a colour, raised to the power and mixed with the grey that the table has for its luminance.
vec3 faded(samplerBuffer curve, Tone tone, vec3 ratios, float luminance) {
    const float at = clamp((log(max(luminance, kLuminanceFloor)) - tone.ln_low) * tone.bins_per_ln, 0.0, tone.bins);
    const float bin = min(floor(at), tone.bins - 1.0);
    const vec2 below = texelFetch(curve, int(kToneNode0) + int(bin)).gb, above = texelFetch(curve, int(kToneNode0) + int(bin) + 1).gb;
    const vec2 exponent_and_share = mix(below, above, at - bin);
    // A channel without light keeps some, so that in the dark, where exponents go to 0, it goes grey with the others.
    return mix(vec3(1.0), pow(max(ratios, vec3(kLeastRatio)), vec3(exponent_and_share.x)), exponent_and_share.y);
}

// Displayed light of a pixel, RGB in [0, 1]; `own` is its colour in the display's primaries. Colour keeps its ratios; where
// a channel would exceed white the pixel fades towards the grey of its own luminance. Pixels that are not finite, or have
// no luminance, are black.
vec3 displayed(samplerBuffer curve, Tone tone, vec3 rgb, vec3 own, float display_low, float display_high) {
    if (kForm == kToneLdr) return all(lessThanEqual(abs(rgb), vec3(3.4e38))) ? clamp(own, 0.0, 1.0) : vec3(0.0);
    const float luminance = luminance_of(rgb);
    if (!(luminance > 0.0 && luminance <= 3.4e38)) return vec3(0.0);
    const float d = clamp(displayed_luminance(curve, tone, luminance, display_low, display_high), 0.0, 1.0);
    const vec3 light = kForm == kToneColour ? faded(curve, tone, own / luminance, luminance) * d : max(own * (d / luminance), vec3(0.0));
    const float brightest = max(light.r, max(light.g, light.b));
    if (brightest <= 1.0) return light;
    return clamp(d + (light - d) * ((1.0 - d) / (brightest - d)), 0.0, 1.0);
}

// The same in Rec. 709, whatever the display's limits.
vec3 displayed_unbounded(samplerBuffer curve, Tone tone, vec3 rgb, float display_low, float display_high) {
    if (kForm == kToneLdr) return all(lessThanEqual(abs(rgb), vec3(3.4e38))) ? clamp(rgb, 0.0, 1.0) : vec3(0.0);
    const float luminance = luminance_of(rgb);
    if (!(luminance > 0.0 && luminance <= 3.4e38)) return vec3(0.0);
    const float d = max(displayed_luminance(curve, tone, luminance, display_low, display_high), 0.0);
    return kForm == kToneColour ? faded(curve, tone, rgb / luminance, luminance) * d : rgb * (d / luminance);
}
