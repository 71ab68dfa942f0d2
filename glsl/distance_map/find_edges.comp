#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Distance maps, lowest bounds of the texels: one group of texels per invocation, one region per workgroup
// (shared/distance_map.h).

#include "shared/distance_map.h"

layout(local_size_x = 16, local_size_y = 16) in;  // kRegion / kGroup

layout(binding = 0) uniform usamplerBuffer regions;  // rgba32ui, two texels each
layout(binding = 1) uniform usamplerBuffer distances;  // two halves, side by side
layout(binding = 2, r32ui) writeonly uniform uimageBuffer bounds;

void main() {
    const int at = int(gl_WorkGroupID.x * 2u);
    const uvec4 a = texelFetch(regions, at), b = texelFetch(regions, at + 1);
    const int side = int(b.x), first = int(b.y * kMapUnit);
    const ivec2 corner = ivec2(a.zw) + ivec2(gl_LocalInvocationID.xy) * int(kGroup);
    float inverse[6][8];  // with what is around the group
    for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 8; i += 2) {
            const ivec2 here = clamp(corner + ivec2(i - 2, j - 1), ivec2(0), ivec2(side - 2, side - 1));
            const vec2 two = 1.0 / unpackHalf2x16(texelFetch(distances, (first + here.y * side + here.x) / 2).r);
            inverse[j][i] = two.x, inverse[j][i + 1] = two.y;
        }
    // An edge is where, of a row of three inverse distances, the middle one is off the mean of the others by more than
    // the bias and what halves round: planes have none, and lower steps shade nothing.
    const float bend = 1.0 / (float(side) * uintBitsToFloat(b.z)) + 2.0 * kMapRounding;
    float least = 1e30, most = 0.0;
    bool edge = false;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const float s = inverse[j + 1][i + 2];
            const float left = inverse[j + 1][i + 1], right = inverse[j + 1][i + 3], up = inverse[j][i + 2], down = inverse[j + 2][i + 2];
            const ivec2 texel = corner + ivec2(i, j);
            // At the border of the square there is no neighbour to tell.
            const bool inner_x = texel.x > 0 && texel.x < side - 1, inner_y = texel.y > 0 && texel.y < side - 1;
            const float step_ = (bend + kMapBias * s) * s;
            edge = edge || (inner_x && abs(left + right - 2.0 * s) > step_) || (inner_y && abs(up + down - 2.0 * s) > step_);
            least = min(least, 1.0 / s);
            most = max(most, 1.0 / s);
        }
    const int groups = side / int(kGroup);
    const ivec2 place = corner / int(kGroup);
    const vec2 bound = min(vec2(least, most), vec2(kMapFar)) * vec2(edge ? -1.0 : 1.0, 1.0);
    imageStore(bounds, first / 8 + place.y * groups + place.x, uvec4(packHalf2x16(bound)));
}
