// A pixel of the scene as displayed light, for composite.comp, shown_light.comp and display_light.comp.

#include "shared/bloom.h"
#include "tone.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 1) const uint kBloom = 0u;
layout(constant_id = 2) const uint kRows = 1u;       // pixels of a column that one invocation does
layout(constant_id = 3) const uint kPrimaries = 0u;  // the display has others than Rec. 709

layout(binding = 0, rgba32f) readonly uniform image2D scene_image;
layout(binding = 1) uniform samplerBuffer curve;
layout(binding = 2) uniform sampler2D bloom;  // displayed light; the scene itself where there is none
layout(push_constant, scalar) uniform Push { CompositePush push; };

vec3 of_the_display(vec3 rgb) {
    return kPrimaries == 0u ? rgb : vec3(dot(push.red, rgb), dot(push.green, rgb), dot(push.blue, rgb));
}

Gamut gamut_of_the_display() {
    if (kPrimaries == 0u) return rec709_gamut();
    const mat3 cones = transpose(mat3(push.cones_long, push.cones_middle, push.cones_short));
    return Gamut(push.luminance, cones, inverse(cones));
}

vec3 scene_light(uvec2 at) { return imageLoad(scene_image, ivec2(at)).rgb; }

vec3 bloom_light(uvec2 at) {
    // The bloom texture covers whole blocks: its last row and column may reach beyond the image.
    const vec2 blocks = vec2(textureSize(bloom, 0));
    return push.bloom * textureLod(bloom, (vec2(at) + 0.5) / (float(kBloomShrink) * blocks), 0.0).rgb;
}

vec3 light[kRows];  // that the display shows of the pixels of a column, in its primaries: 0 at its darkest, 1 at its brightest

void find_light(Tone tone, Gamut gamut, uvec2 first) {
    uint bright = 0u;  // rows, a bit for each
    [[unroll]] for (uint row = 0u; row < kRows; ++row) {
        const vec3 rgb = perceived(tone, scene_light(first + uvec2(0u, row)));
        const Asked of = asked(curve, tone, rgb, of_the_display(rgb), push.display_low, push.display_high);
        light[row] = of.shown ? of.light : near_gamut(gamut, kTone, of.light, of.luminance);
        bright |= !of.shown && is_too_bright(excess_of(gamut, light[row])) ? 1u << row : 0u;
    }
    if ((kTone & kGamutMask) == kGamutLuminance) {
        // Few are. A loop over these that asks at its end, since a CPU device goes through what a branch leaves out.
        do {
            const uint at = uint(findLSB(bright));
            vec3 one = light[0];
            [[unroll]] for (uint row = 1u; row < kRows; ++row) one = row == at ? light[row] : one;
            if (bright != 0u) one = whitened(gamut, one, excess_of(gamut, one));
            [[unroll]] for (uint row = 0u; row < kRows; ++row) light[row] = row == at ? one : light[row];
            bright &= bright - 1u;
        } while (bright != 0u);
    }
    if (kBloom != 0u)
        [[unroll]] for (uint row = 0u; row < kRows; ++row)
            light[row] = clamp(light[row] + of_the_display(bloom_light(first + uvec2(0u, row))), 0.0, 1.0);
}
