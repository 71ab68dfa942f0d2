#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Light of some nodes: pixels, or tents of a level.

#include "shared/light_sums.h"

layout(local_size_x = 64) in;

layout(binding = 0, rgba32f) readonly uniform image2D picture;
layout(binding = 1, scalar) readonly buffer Sums { vec4 sums[]; };
layout(binding = 2, scalar) readonly buffer Nodes { uint nodes[]; };
layout(binding = 3, scalar) writeonly buffer Light { vec4 light[]; };  // RGB, lx
layout(push_constant, scalar) uniform Push { LightNodesPush push; };

#include "light_sums.glsl"

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= push.nodes) return;
    const uint node = nodes[i], pixels = push.size.x * push.size.y;
    light[i] = node < pixels ? vec4(light_of_pixel(ivec2(node % push.size.x, node / push.size.x), push.scale, push.offset, push.pixel_area), 0.0)
                             : sums[node - pixels];
}
