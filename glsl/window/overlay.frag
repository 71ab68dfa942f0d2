#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Instruments over the picture: sRGB codes as they are, or, in a HDR10 window, as luminance up to a white of their own.

#include "shared/present.h"

layout(binding = 0) uniform sampler2D coverage;
layout(push_constant, scalar) uniform Push { OverlayPush push; };
layout(location = 0) in vec2 texture_uv;
layout(location = 1) in vec4 own_colour;
layout(location = 0) out vec4 shown;

// SMPTE ST 2084: code of luminance, cd/m^2.
vec3 pq(vec3 luminance) {
    const vec3 y = pow(luminance / 10000.0, vec3(0.1593017578125));
    return pow((0.8359375 + 18.8515625 * y) / (1.0 + 18.6875 * y), vec3(78.84375));
}

void main() {
    shown = vec4(own_colour.rgb, own_colour.a * textureLod(coverage, texture_uv, 0.0).r);
    if (push.hdr10 == 0u) return;
    const vec3 light = mix(shown.rgb / 12.92, pow((shown.rgb + 0.055) / 1.055, vec3(2.4)), step(vec3(0.04045), shown.rgb));
    // Rec. 709 to Rec. 2020 (ITU-R BT.2087).
    const mat3 to_2020 = mat3(0.6274, 0.0691, 0.0164, 0.3293, 0.9195, 0.0880, 0.0433, 0.0114, 0.8956);
    shown.rgb = pq(push.white * (to_2020 * light));
}
