#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Clipmaps, from a level that was drawn to its texels, two per invocation (shared/clipmap.h).

#include "shared/clipmap.h"

layout(local_size_x = 16, local_size_y = 16) in;

layout(binding = 0) uniform texture2D drawn;  // depth; 0 without a surface
layout(binding = 1, scalar) writeonly buffer Distances { uint distances[]; };  // two halves, side by side
layout(push_constant, scalar) uniform Push { StoreClipmapPush push; };

float distance_at(ivec2 texel) {
    const float depth = texelFetch(drawn, texel, 0).r;
    return depth > 0.0 ? min(push.farthest - depth * push.range, kMapFar) : kMapFar;
}

void main() {
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy) * ivec2(2, 1);
    if (any(greaterThanEqual(uvec2(texel), uvec2(push.side)))) return;
    const vec2 two = vec2(distance_at(texel), distance_at(texel + ivec2(1, 0)));
    distances[int(push.first / 2u) + (texel.y * int(push.side) + texel.x) / 2] = packHalf2x16(two);
}
