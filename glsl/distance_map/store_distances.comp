#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Distance maps, from what was drawn to texels and their lowest bounds: one group of texels per invocation, one region per
// workgroup (shared/distance_map.h).

#include "shared/distance_map.h"

layout(local_size_x = 16, local_size_y = 16) in;  // kRegion / kGroup

layout(binding = 0) uniform texture2D drawn;  // kMapNear / distance; 0 without a surface
layout(binding = 1) uniform usamplerBuffer regions;  // rgba32ui, two texels each
layout(binding = 2, r32ui) writeonly uniform uimageBuffer distances;  // two halves, side by side
layout(binding = 3, r32ui) writeonly uniform uimageBuffer bounds;

void main() {
    const int at = int(gl_WorkGroupID.x * 2u);
    const uvec4 a = texelFetch(regions, at), b = texelFetch(regions, at + 1);
    const ivec2 image = ivec2(a.xy), corner = ivec2(a.zw);
    const int side = int(b.x);
    const ivec2 group = ivec2(gl_LocalInvocationID.xy) * int(kGroup);
    float inverse[6][6];  // with a texel around the group
    for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 6; ++i) {
            const ivec2 here = clamp(corner + group + ivec2(i, j) - 1, ivec2(0), ivec2(side - 1));
            inverse[j][i] = texelFetch(drawn, image + here - corner, 0).r * (1.0 / kMapNear);
        }
    float least = 1e30, most = 0.0;
    bool edge = false;
    const uint first = b.y * kMapUnit;
    // An edge is where, of a row of three inverse distances, the middle one is off the mean of the others by more than the
    // bias: planes have none, and lower steps shade nothing.
    const float bend = 1.0 / (float(side) * uintBitsToFloat(b.z)) + kMapRounding;
    for (int j = 0; j < 4; ++j) {
        vec4 row;
        for (int i = 0; i < 4; ++i) {
            const float s = inverse[j + 1][i + 1];
            const float left = inverse[j + 1][i], right = inverse[j + 1][i + 2], up = inverse[j][i + 1], down = inverse[j + 2][i + 1];
            const ivec2 texel = corner + group + ivec2(i, j);
            // At the border of the square there is no neighbour to tell.
            const bool inner_x = texel.x > 0 && texel.x < side - 1, inner_y = texel.y > 0 && texel.y < side - 1;
            edge = edge || (inner_x && abs(left + right - 2.0 * s) > (bend + kMapBias * s) * s) || (inner_y && abs(up + down - 2.0 * s) > (bend + kMapBias * s) * s);
            row[i] = s > 0.0 ? 1.0 / s : 1e30;
            least = min(least, row[i]);
            most = max(most, row[i]);
        }
        const uint word = (first + uint((corner.y + group.y + j) * side + corner.x + group.x)) / 2u;
        imageStore(distances, int(word), uvec4(packHalf2x16(min(row.xy, vec2(6e4)))));
        imageStore(distances, int(word) + 1, uvec4(packHalf2x16(min(row.zw, vec2(6e4)))));
    }
    const uint groups = uint(side) / kGroup;
    const uint place = first / 8u + (uint(corner.y + group.y) / kGroup) * groups + uint(corner.x + group.x) / kGroup;
    imageStore(bounds, int(place), uvec4(packHalf2x16(min(vec2(least, most), vec2(6e4)) * vec2(edge ? -1.0 : 1.0, 1.0))));
}
