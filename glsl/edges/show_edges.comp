#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Puts the means where they belong.

#include "shared/edges.h"

layout(local_size_x = kEdgesPerGroup) in;
layout(binding = 0) uniform usamplerBuffer counts;
layout(binding = 1) uniform usamplerBuffer edges;
layout(binding = 2) uniform samplerBuffer means;
layout(binding = 3, rgba32f) uniform image2D scene_image;
layout(push_constant, scalar) uniform Push { EdgesPush push; };

void main() {
    const uint number = gl_GlobalInvocationID.x;
    if (number >= texelFetch(counts, 3).r) return;
    const uint index = texelFetch(edges, int(number)).r;
    imageStore(scene_image, ivec2(index % push.size.x, index / push.size.x), texelFetch(means, int(number)));
}
