#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Display codes of a buffer to a window.

#include "texels.glsl"
#include "shared/present.h"

TEXELS(0, uint, words);
layout(push_constant, scalar) uniform Push { PresentPush push; };
layout(location = 0) out vec4 shown;

vec3 shares_of(uvec3 code) { return vec3(code) / (push.bits == 8u ? 255.0 : 1023.0); }

vec3 codes(ivec2 pixel) {
    const uint word = texel_at(words, pixel.y * int(push.size.x) + pixel.x).r;
    return shares_of(push.bits == 8u ? uvec3(word & 255u, word >> 8 & 255u, word >> 16 & 255u)
                                     : uvec3(word & 1023u, word >> 10 & 1023u, word >> 20 & 1023u));
}

#include "present.glsl"
