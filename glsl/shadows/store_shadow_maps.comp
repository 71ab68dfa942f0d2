#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Shadow maps, from what was drawn to texels: as many as a tile has per workgroup, two per invocation and turn.

#include "shared/shadow_map.h"

layout(local_size_x_id = 0) in;

layout(binding = 0, scalar) readonly buffer Drawn { vec2 drawn[]; };  // kMapNear / distance; 0 without a surface
layout(binding = 1, scalar) readonly buffer List { DrawnTexels list[]; };
layout(binding = 2, scalar) writeonly buffer Words { uint words[]; };

void main() {
    const DrawnTexels texels = list[gl_WorkGroupID.x];
    uint k = gl_LocalInvocationID.x;
    do {
        const vec2 s = drawn[texels.from / 2u + k] * (1.0 / kMapNear);
        words[texels.to + k] = packHalf2x16(min(mix(vec2(kMapFar), 1.0 / s, greaterThan(s, vec2(0.0))), vec2(kMapFar)));
        k += gl_WorkGroupSize.x;
    } while (k < kTileTexels / 2u);
}
