#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Light scattered in the eye, at the top: every texel takes from every other by the angle between them, and from the lamps that
// are far outside the picture.

#include "shared/scatter.h"

layout(local_size_x = 64) in;

layout(binding = 0, rgba32f) readonly uniform image2D means;
layout(binding = 1) uniform samplerBuffer weights;  // for each texel taken from, those that take, row by row
layout(binding = 2) uniform samplerBuffer veil;     // of far lamps, for each texel that takes
layout(binding = 3, rgba32f) writeonly uniform image2D seen;
layout(push_constant, scalar) uniform Push { ScatterTopPush push; };

void main() {
    const uvec2 takes = push.size + 2u * kScatterDownMargin, gives = push.size + 2u * kScatterUpMargin;
    const uint count = takes.x * takes.y, index = gl_GlobalInvocationID.x;
    if (index >= count) return;
    vec3 sum = texelFetch(veil, int(index)).rgb;
    int weight = int(index);
    for (uint y = 0u; y < gives.y; ++y)
        for (uint x = 0u; x < gives.x; ++x) {
            sum += texelFetch(weights, weight).r * imageLoad(means, ivec2(x, y)).rgb;
            weight += int(count);
        }
    imageStore(seen, ivec2(index % takes.x, index / takes.x), vec4(sum, 1.0));
}
