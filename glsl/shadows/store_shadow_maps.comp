#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

// Shadow maps, from what was drawn to texels: one group of texels per invocation, one region per workgroup
// (shared/shadow_map.h). Moving casters are drawn over still ones: the nearer of both stays.

#include "shared/shadow_map.h"

layout(local_size_x = 16, local_size_y = 16) in;  // kRegion / kGroup

layout(binding = 0) uniform texture2D drawn;  // kMapNear / distance; 0 without a surface
layout(binding = 3, scalar) readonly buffer Small { uint small[]; };  // the same of small triangles, bits of floats
layout(binding = 1, scalar) readonly buffer Regions { MapRegion regions[]; };
layout(binding = 2, scalar) buffer Distances { uint distances[]; };  // two halves, side by side

void main() {
    const MapRegion region = regions[gl_WorkGroupID.x];
    const ivec2 image = ivec2(region.drawn_x, region.drawn_y), corner = ivec2(region.x, region.y);
    const int side = int(region.side);
    const ivec2 group = ivec2(gl_LocalInvocationID.xy) * int(kGroup);
    const bool over = region.saved != kNotSaved, save = over && (region.saved & kSaveNow) != 0u;
    const int saved = int((region.saved & ~kSaveNow) * (kMapUnit / 2u));
    for (int k = 0; k < 8; ++k) {
        const ivec2 texel = group + ivec2(k % 2 * 2, k / 2);
        const int first = (image.y + texel.y) * textureSize(drawn, 0).x + image.x + texel.x;
        const vec2 rasterized = vec2(texelFetch(drawn, image + texel, 0).r, texelFetch(drawn, image + texel + ivec2(1, 0), 0).r);
        const vec2 s = max(rasterized, vec2(uintBitsToFloat(small[first]), uintBitsToFloat(small[first + 1]))) * (1.0 / kMapNear);
        vec2 norm = min(mix(vec2(kMapFar), 1.0 / s, greaterThan(s, vec2(0.0))), vec2(kMapFar));
        const int word = (int(region.first * kMapUnit) + (corner.y + texel.y) * side + corner.x + texel.x) / 2;
        const int kept = saved + (texel.y * int(kRegion) + texel.x) / 2;
        for (int once = 0; once < (over ? 1 : 0); ++once) {  // a CPU device skips loops, not branches
            const uint still = distances[save ? word : kept];
            norm = min(norm, unpackHalf2x16(still));
            if (save) distances[kept] = still;
        }
        distances[word] = packHalf2x16(norm);
    }
}
