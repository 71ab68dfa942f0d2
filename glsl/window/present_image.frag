#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Display codes of an image to a window.

#include "shared/present.h"

layout(binding = 0) uniform sampler2D picture;
layout(push_constant, scalar) uniform Push { PresentPush push; };
layout(location = 0) out vec4 shown;

vec3 codes(ivec2 pixel) { return texelFetch(picture, pixel, 0).rgb; }

#include "present.glsl"
