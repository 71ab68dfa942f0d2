#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Distance maps, higher levels of their bounds: one region per invocation (shared/distance_map.h).

#include "shared/distance_map.h"

layout(local_size_x = 8) in;

layout(binding = 0) uniform usamplerBuffer regions;  // rgba32ui, two texels each
layout(binding = 1, r32ui) uniform uimageBuffer bounds;
layout(push_constant, scalar) uniform Push { uint count; } push;

void main() {
    if (gl_GlobalInvocationID.x >= push.count) return;
    const int at = int(gl_GlobalInvocationID.x * 2u);
    const uvec4 a = texelFetch(regions, at), b = texelFetch(regions, at + 1);
    const uint side = b.x, base = b.y * kMapUnit / 8u;
    for (uint level = 1u; level < kBoundLevels; ++level) {
        const uint below = side / kGroup >> level - 1u, row = below / 2u;  // groups in a row
        const uint from = base + (side * side - (side >> level - 1u) * (side >> level - 1u)) / 12u;
        const uint to = base + (side * side - (side >> level) * (side >> level)) / 12u;
        const uvec2 corner = a.zw / kGroup >> level;
        const uint count = kRegion / kGroup >> level;
        for (uint y = corner.y; y < corner.y + count; ++y)
            for (uint x = corner.x; x < corner.x + count; ++x) {
                float least = 1e30, most = 0.0;
                bool edge = false;
                for (uint k = 0u; k < 4u; ++k) {
                    const vec2 of = unpackHalf2x16(imageLoad(bounds, int(from + (2u * y + k / 2u) * below + 2u * x + k % 2u)).r);
                    least = min(least, abs(of.x));
                    most = max(most, of.y);
                    edge = edge || of.x < 0.0;
                }
                imageStore(bounds, int(to + y * row + x), uvec4(packHalf2x16(vec2(edge ? -least : least, most))));
            }
    }
}
