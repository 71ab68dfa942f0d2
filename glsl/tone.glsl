// From scene luminance to displayed light, for bright.comp and composite.comp.

#include "shared/composite.h"
#include "shared/photometry.h"
#include "gamut.glsl"

const float kLeastRatio = 0.01;

layout(constant_id = 0) const uint kTone = kToneCurve;
const uint kForm = kTone & kToneForm;

struct Tone {
    float scale, white;          // Reinhard
    float low, gain;             // linear
    float ln_low, bins_per_ln;   // curve
    float bins;
    vec3 rods;                   // rods
    mat3 colour;
    float offset, unit;          // responses
};

Tone read_tone(samplerBuffer curve) {
    const vec4 a = texelFetch(curve, 0), b = texelFetch(curve, 1);
    const vec3 rods = kForm == kToneRods ? texelFetch(curve, 4).rgb : vec3(0.0);
    const vec2 responses = kForm == kToneColour ? texelFetch(curve, 3).ba : vec2(0.0);
    mat3 colour = mat3(1.0);
    if (kForm == kToneRods) colour = transpose(mat3(texelFetch(curve, 5).rgb, texelFetch(curve, 6).rgb, texelFetch(curve, 7).rgb));
    return Tone(a.r, a.g, a.b, a.a, b.r, b.g, b.b, rods, colour, responses.r, responses.g);
}

float luminance_of(vec3 rgb) { return dot(rgb, vec3(kRed, kGreen, kBlue)); }

// Scotopic luminance over that of white. Light outside of Rec. 709 counts as the nearest inside.
float scotopic_of(vec3 rgb) {
    if ((kTone & kTonePhotopicRods) != 0u) return luminance_of(rgb);
    rgb = max(rgb, vec3(0.0));
    const float x = dot(rgb, vec3(kXRed, kXGreen, kXBlue)), y = luminance_of(rgb), z = dot(rgb, vec3(kZRed, kZGreen, kZBlue));
    return y > 0.0 ? y * ((kScotopicSlope * (1.0 + (y + z) / x) - kScotopicOffset) / kScotopicOfWhite) : 0.0;
}

// What is seen of a pixel, cd/m^2, before it is mapped: the eye has adapted to colours and rods add grey, or dim light loses its colour.
vec3 perceived(Tone tone, vec3 rgb) {
    if (kForm == kToneRods) rgb = tone.colour * rgb + scotopic_of(rgb) * tone.rods;
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

Mapped mapped(samplerBuffer curve, Tone tone, vec3 rgb, float display_low, float display_high) {
    const float luminance = max(luminance_of(rgb), 0.0);
    if (kForm == kToneReinhard) {
        const float x = tone.scale * luminance;
        return Mapped(x * (1.0 + x * tone.white) / (1.0 + x), 1.0, 1.0);
    }
    if (kForm == kToneLinear || kForm == kToneRods) return Mapped((luminance - tone.low) * tone.gain, 1.0, 1.0);
    const vec4 node = node_at(curve, tone, luminance);
    if (kForm == kToneColour) {
        const float rods = node_at(curve, tone, scotopic_of(rgb)).b;
        const float seen = clamp(node.r + rods + tone.offset, 0.0, 0.9999999);
        // Far beyond white all is the same.
        return Mapped(min(tone.unit * pow(seen / (1.0 - seen), 1.0 / kResponsePower), 1000.0), node.g, node.r / max(node.r + rods, 1e-30));
    }
    return Mapped((exp(node.r) - display_low) / (display_high - display_low), 1.0, 1.0);
}

// Ratios of a colour to its luminance, raised to the power and mixed with grey.
vec3 faded(vec3 ratios, Mapped to) {
    // A channel with less light than kLeastRatio, or negative light, gets that from the others: powers are steep near 0, and a colour that
    // leaves the primaries would have an edge there. In the dark, where exponents go to 0, it goes grey with the others.
    const float least = min(ratios.r, min(ratios.g, ratios.b));
    if (least < kLeastRatio) ratios = max(1.0 + (ratios - 1.0) * ((1.0 - kLeastRatio) / (1.0 - least)), vec3(kLeastRatio));
    return mix(vec3(1.0), pow(ratios, vec3(to.exponent)), to.share);
}

bool is_finite(float x) { return abs(x) <= 3.4e38; }

// Displayed light of a pixel, RGB in [0, 1]; `own` is its colour in the display's primaries, `gamut`. Pixels that are not finite are
// black; those without luminance are shown as what has hardly any.
vec3 displayed(samplerBuffer curve, Tone tone, vec3 rgb, vec3 own, Gamut gamut, float display_low, float display_high) {
    if (kForm == kToneLdr) return is_finite(rgb.r) && is_finite(rgb.g) && is_finite(rgb.b) ? clamp(own, 0.0, 1.0) : vec3(0.0);
    const float luminance = luminance_of(rgb);
    if (!is_finite(luminance)) return vec3(0.0);
    const Mapped to = mapped(curve, tone, rgb, display_low, display_high);
    const float d = clamp(to.luminance, 0.0, 1.0);
    if (luminance <= 0.0) return vec3(d);
    return in_gamut(gamut, kTone, kForm == kToneColour ? faded(own / luminance, to) * d : own * (d / luminance), d);
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
