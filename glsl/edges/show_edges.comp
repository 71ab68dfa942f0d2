#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Puts the means where they belong.

#include "texels.glsl"
#include "shared/edges.h"

layout(local_size_x = kEdgesPerGroup) in;
TEXELS(0, uint, counts);
TEXELS(1, uint, edges);
TEXELS(2, vec4, means);
layout(binding = 3, rgba32f) uniform image2D scene_image;
layout(push_constant, scalar) uniform Push { EdgesPush push; };

#include "edges_list.glsl"

void main() {
    const uint number = gl_GlobalInvocationID.x;
    if (number >= texel_at(counts, 3).r) return;
    const ivec2 pixel = edge_at(texel_at(edges, int(number)).r);
    imageStore(scene_image, pixel, texel_at(means, int(number)));
}
