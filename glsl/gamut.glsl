// Displayed light as a display can show it, for tone.glsl.

#include "shared/gamut.h"
#include "shared/photometry.h"

// Three primaries, of which (1, 1, 1) is white.
struct Gamut {
    vec3 luminance;   // of each primary, over that of white
    mat3 cones;       // responses of cones as Oklab has them, 1 to white
    mat3 from_cones;  // the inverse
};

Gamut rec709_gamut() {
    return Gamut(vec3(kRed, kGreen, kBlue), transpose(mat3(kOklabLong, kOklabMiddle, kOklabShort)),
                 transpose(mat3(kOklabRed, kOklabGreen, kOklabBlue)));
}

float largest(vec3 light) { return max(light.r, max(light.g, light.b)); }

// Light as bright as white at most, of its colour.
vec3 dimmed(Gamut gamut, vec3 light) { return light / max(dot(gamut.luminance, light), 1.0); }

// How dimmed light lies to what a display has.
struct Excess {
    float x, most, knee;  // its largest channel, and of that chromaticity at luminance 1; where its colour begins to give way
};

Excess excess_of(Gamut gamut, vec3 light) {
    const float x = largest(light), most = x / dot(gamut.luminance, light);
    return Excess(x, most, min(kGamutKnee, most - 1.0));
}

bool is_too_bright(Excess of) { return of.x > 1.0 - of.knee; }

// Dimmed light that is too bright for its colour, towards white in Oklab, on a straight line of one hue, and as bright as its
// largest channel lets it be. No channel of `light` is negative.
vec3 whitened(Gamut gamut, vec3 light, Excess of) {
    const float x = of.x, most = of.most, knee = of.knee;
    // max(x, 1), and what it leaves of x, with a parabola across the edge. Light of the luminance of white ends behind it.
    const float into = x - (1.0 - knee);
    const float beyond = x >= 1.0 + knee ? x : 1.0 + into * into / (4.0 * knee);
    const float channel = x + 1.0 - beyond;
    const float lost = (kGamutLost + kGamutLostOfBright / most) * min((most - 1.0) / kGamutWay, 1.0) * clamp((beyond - 1.0) / (most - 1.0), 0.0, 1.0);
    // The cubes' difference goes to 0 with what is lost, without a remainder of rounding.
    const vec3 cones = gamut.cones * light;
    const vec3 root = sign(cones) * pow(abs(cones), vec3(1.0 / 3.0));
    const vec3 change = lost * (dot(kOklabLightness, root) - root);
    const vec3 moved = max(light + gamut.from_cones * (change * (3.0 * root * (root + change) + change * change)), 0.0);
    return moved * (channel / max(largest(moved), 1e-30));
}

// Light of displayed luminance d as the display can show it, but for what whitened() does: with kGamutLuminance it is dimmed. A colour
// outside the primaries goes towards the grey of d as far as it must.
vec3 near_gamut(Gamut gamut, uint tone, vec3 light, float d) {
    if ((tone & kGamutMask) == kGamutClip) return clamp(light, 0.0, 1.0);
    const float least = min(light.r, min(light.g, light.b));
    if (least < 0.0) light = max(d + (light - d) * (d / (d - least)), vec3(0.0));
    return (tone & kGamutMask) == kGamutChromaticity ? light / max(largest(light), 1.0) : dimmed(gamut, light);
}

vec3 in_gamut(Gamut gamut, uint tone, vec3 light, float d) {
    light = near_gamut(gamut, tone, light, d);
    if ((tone & kGamutMask) != kGamutLuminance) return light;
    const Excess of = excess_of(gamut, light);
    return is_too_bright(of) ? whitened(gamut, light, of) : light;
}
