#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Display codes to a window, unchanged where its pixels are those of the picture. Other sizes get means of codes, as a screen's own
// scaler does.

#include "texels.glsl"
#include "shared/present.h"

TEXELS(0, uint, words);
layout(push_constant, scalar) uniform Push { PresentPush push; };
layout(location = 0) out vec4 shown;

vec3 codes(ivec2 pixel) {
    pixel = clamp(pixel, ivec2(0), ivec2(push.size) - 1);
    const uint word = texel_at(words, pixel.y * int(push.size.x) + pixel.x).r;
    if (push.bits == 8u) return unpackUnorm4x8(word).rgb;
    return vec3(word & 1023u, word >> 10 & 1023u, word >> 20 & 1023u) / 1023.0;
}

void main() {
    const vec2 place = (gl_FragCoord.xy - push.origin) * push.step;
    if (push.filtered == 0u) {
        shown = vec4(codes(ivec2(floor(place))), 1.0);
        return;
    }
    const vec2 reach = max(push.step, vec2(1.0));
    const ivec2 first = ivec2(ceil(place - 0.5 - reach)), last = ivec2(floor(place - 0.5 + reach));
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            const vec2 weights = max(1.0 - abs(vec2(x, y) + 0.5 - place) / reach, vec2(0.0));
            sum += weights.x * weights.y * codes(ivec2(x, y));
            total += weights.x * weights.y;
        }
    shown = vec4(sum / total, 1.0);
}
