#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Adds lamps seen directly: luminance times the part of each pixel that the silhouette of their opening covers, exactly, where
// no surface hides it. An invocation owns its pixel and takes the lamps in their order: sums are the same on every run.

#include "shared/luminaire.h"

layout(local_size_x = kLuminaireTile, local_size_y = kLuminaireTile) in;

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
layout(binding = 1, rgba32f) uniform image2D scene_image;
layout(binding = 2) uniform samplerBuffer luminaires;
layout(binding = 3) uniform samplerBuffer silhouettes;
layout(binding = 4) uniform usamplerBuffer tiles;
layout(binding = 5) uniform usamplerBuffer entries;
layout(push_constant, scalar) uniform Push { LuminairesPush push; };

// The area between an edge and the line x = 0 within the unit square: the integral of clamp(x, 0, 1) over the edge's y,
// signed by its direction. Over a closed silhouette that adds up to the area inside, and every term is without cancellation.
float area_left_of(vec2 a, vec2 b) {
    const float low = clamp(a.y, 0.0, 1.0), high = clamp(b.y, 0.0, 1.0), run = b.y - a.y;
    const float slope = run == 0.0 ? 0.0 : (b.x - a.x) / run;
    const float x0 = a.x + (low - a.y) * slope, x1 = a.x + (high - a.y) * slope;
    const float left = min(x0, x1), right = max(x0, x1), width = right - left;
    const float l = clamp(left, 0.0, 1.0), r = clamp(right, 0.0, 1.0);
    const float inside = 0.5 * (r - l) * (r + l) + max(right - max(left, 1.0), 0.0);
    const float mean = width > 1e-6 ? inside / width : clamp(left, 0.0, 1.0);
    return mean * (high - low);
}

// Covered part of the pixel whose corner lies at `corner` from the silhouette's origin.
float coverage(vec2 corner, int first, int vertices) {
    float area = 0.0;
    vec2 a = texelFetch(silhouettes, first + max(vertices, 1) - 1).xy - corner, low = vec2(1e30), high = vec2(-1e30);
    for (int i = 0; i < vertices; ++i) {
        const vec2 b = texelFetch(silhouettes, first + i).xy - corner;
        area += area_left_of(a, b);
        low = min(low, b), high = max(high, b);
        a = b;
    }
    // Beside a silhouette the sum is nothing but rounding, which shows when it is multiplied by the luminance of a headlamp.
    const bool beside = any(lessThanEqual(high, vec2(0.0))) || any(greaterThanEqual(low, vec2(1.0)));
    return beside ? 0.0 : clamp(area, 0.0, 1.0);
}

void main() {
    const uint at = gl_WorkGroupID.y * kTilesPerRow + gl_WorkGroupID.x;
    if (at >= push.tiles) return;
    const uvec4 tile = texelFetch(tiles, int(at));
    const uvec2 pixel = tile.xy * kLuminaireTile + gl_LocalInvocationID.xy;
    if (any(greaterThanEqual(pixel, push.size))) return;

    const float drawn = imageLoad(surface_image, ivec2(pixel)).z;
    const float depth = drawn > 0.0 ? drawn : 1e30;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < tile.w; ++i) {
        const uint entry = texelFetch(entries, int(tile.z + i)).r;
        const int source = int((entry & ~kCoversTile) * kTexelsPerLuminaire);
        const vec4 a = texelFetch(luminaires, source), b = texelFetch(luminaires, source + 1);
        const bool whole = (entry & kCoversTile) != 0u;
        const float covered = coverage(vec2(pixel) - b.xy, int(b.z), whole ? 0 : int(b.w));
        sum += a.rgb * ((whole ? 1.0 : covered) * clamp((depth - a.w) / kLuminaireEdge, 0.0, 1.0));
    }
    const vec4 scene = imageLoad(scene_image, ivec2(pixel));
    imageStore(scene_image, ivec2(pixel), vec4(scene.rgb + sum, scene.a));
}
