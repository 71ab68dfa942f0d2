#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Shadow maps, tiles that moving casters were drawn into, as they are without these: one per workgroup.

#include "shared/shadow_map.h"

layout(local_size_x_id = 0) in;

layout(binding = 0, scalar) readonly buffer Still { uint still[]; };  // texels of all maps with what stands still, two halves each
layout(binding = 1, scalar) writeonly buffer Words { uint words[]; };
layout(binding = 2, scalar) buffer Changed { uint changed[]; };

void main() {
    const uint place = kChangedHead + changed[3] + 3u * gl_WorkGroupID.x;
    const uint tile = changed[place], word = changed[place + 1u], stride = changed[place + 2u];
    uint k = gl_LocalInvocationID.x;
    do {
        const uint at = word + k / (kRegion / 2u) * stride + k % (kRegion / 2u);
        words[at] = still[at];
        k += gl_WorkGroupSize.x;
    } while (k < kTileTexels / 2u);
    if (gl_LocalInvocationID.x == 0u) changed[kChangedHead + tile] = 0u;
}
