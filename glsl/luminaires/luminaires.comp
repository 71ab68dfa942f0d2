#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Adds lamps seen directly: luminance times the part of each pixel that the silhouette of their opening covers, exactly, where
// no surface hides it. An invocation owns its pixel and takes the lamps in their order: sums are the same on every run.

#include "texels.glsl"
#include "shared/luminaire.h"

layout(local_size_x = kLuminaireTile, local_size_y = kLuminaireTile) in;

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
layout(binding = 1, rgba32f) uniform image2D scene_image;
TEXELS(2, vec4, luminaires);
TEXELS(3, vec2, silhouettes);
TEXELS(4, uvec4, tiles);
TEXELS(5, uint, entries);
layout(push_constant, scalar) uniform Push { LuminairesPush push; };

#include "coverage.glsl"

void main() {
    const uint at = gl_WorkGroupID.y * kTilesPerRow + gl_WorkGroupID.x;
    if (at >= push.tiles) return;
    const uvec4 tile = texel_at(tiles, int(at));
    const uvec2 pixel = tile.xy * kLuminaireTile + gl_LocalInvocationID.xy;
    if (any(greaterThanEqual(pixel, push.size))) return;

    const float drawn = imageLoad(surface_image, ivec2(pixel)).z;
    const float depth = drawn > 0.0 ? drawn : 1e30;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < tile.w; ++i) {
        const uint entry = texel_at(entries, int(tile.z + i)).r;
        const int source = int((entry & ~kCoversTile) * kTexelsPerLuminaire);
        const vec4 a = texel_at(luminaires, source), b = texel_at(luminaires, source + 1);
        const bool whole = (entry & kCoversTile) != 0u;
        const float covered = coverage(vec2(pixel) - b.xy, int(b.z), whole ? 0 : int(b.w));
        sum += a.rgb * ((whole ? 1.0 : covered) * clamp((depth - a.w) / kLuminaireEdge, 0.0, 1.0));
    }
    const vec4 scene = imageLoad(scene_image, ivec2(pixel));
    imageStore(scene_image, ivec2(pixel), vec4(scene.rgb + sum, scene.a));
}
