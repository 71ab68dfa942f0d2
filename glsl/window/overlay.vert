#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Triangles of instruments over the picture, in px of the window.

#include "shared/present.h"

layout(location = 0) in vec2 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colour;
layout(push_constant, scalar) uniform Push { OverlayPush push; };

layout(location = 0) out vec2 texture_uv;
layout(location = 1) out vec4 own_colour;

void main() {
    gl_Position = vec4(position * push.scale - 1.0, 0.0, 1.0);
    texture_uv = uv;
    own_colour = colour;
}
