#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Light scattered in the eye, at the top: every texel takes from every other by the angle between them, and from the lamps that
// are far outside the picture. Four texels an invocation.

#include "texels.glsl"
#include "shared/eye_scatter.h"

layout(local_size_x = 32) in;

layout(binding = 0, rgba32f) readonly uniform image2D means;
TEXELS(1, vec4, weights);  // for each texel taken from, those that take, row by row, by four
TEXELS(2, vec4, veil);     // of far lamps, for each texel that takes
layout(binding = 3, rgba32f) writeonly uniform image2D seen;
layout(push_constant, scalar) uniform Push { ScatterTopPush push; };

void main() {
    const uvec2 takes = push.size + 2u * kScatterDownMargin, gives = push.size + 2u * kScatterUpMargin;
    const uint count = takes.x * takes.y, fours = (count + 3u) / 4u, index = gl_GlobalInvocationID.x;
    if (index >= fours) return;
    vec3 sum[4];
    [[unroll]] for (uint i = 0u; i < 4u; ++i) sum[i] = texel_at(veil, int(min(4u * index + i, count - 1u))).rgb;
    int weight = int(index);
    for (uint y = 0u; y < gives.y; ++y)
        for (uint x = 0u; x < gives.x; ++x) {
            const vec3 light = imageLoad(means, ivec2(x, y)).rgb;
            const vec4 w = texel_at(weights, weight);
            [[unroll]] for (int i = 0; i < 4; ++i) sum[i] += w[i] * light;
            weight += int(fours);
        }
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        const uint texel = 4u * index + i;
        if (texel < count) imageStore(seen, ivec2(texel % takes.x, texel / takes.x), vec4(sum[i], 1.0));
    }
}
