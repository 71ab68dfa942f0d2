#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Display codes of an image to a window.

#include "shared/present.h"

layout(binding = 0) uniform sampler2D picture;
layout(push_constant, scalar) uniform Push { PresentPush push; };
layout(location = 0) out vec4 shown;

vec3 shares_of(uvec3 code) { return vec3(code) / (push.bits == 8u ? 255.0 : 1023.0); }

// From whole codes, as those of a buffer are, so that both show the same to the last bit.
vec3 codes(ivec2 pixel) {
    return shares_of(uvec3(texelFetch(picture, pixel, 0).rgb * (push.bits == 8u ? 255.0 : 1023.0) + 0.5));
}

#include "present.glsl"
