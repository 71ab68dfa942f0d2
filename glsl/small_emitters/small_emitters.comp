#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Adds what small emitters emit: luminance times the part of each pixel that their silhouette covers, exactly, times the part of
// that which nothing hides, at kEdgeSamples points. What hides it is found among the facets that the pixel and
// its neighbours see in their middles, among those of its own mesh that are near it, and among the emitters that are a pixel wide.
// Of other meshes a facet that is narrower than a pixel, or has holes, hides the pixel whose middle sees it and no other.

#include "texels.glsl"
#include "shared/edges.h"
#include "shared/gbuffer.h"
#include "shared/luminaire.h"
#include "shared/small_emitter.h"

layout(local_size_x = kLuminaireTile, local_size_y = kLuminaireTile) in;

layout(binding = 0, rg32ui) readonly uniform uimage2D triangles;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) uniform image2D scene_image;
TEXELS(3, vec4, emitters);
TEXELS(4, vec2, silhouettes);
TEXELS(5, uvec4, tiles);
TEXELS(6, uint, entries);
TEXELS(7, vec4, instances);
TEXELS(8, vec2, vertices);
TEXELS(9, uvec4, facets);
layout(push_constant, scalar) uniform Push { SmallEmittersPush push; };

const uint kPoints = kEdgeSamples;

#include "coverage.glsl"
#include "facets.glsl"
#include "neighbours.glsl"

float nearest[kEdgeSamples];  // inverse depth of what covers a point of the pixel, 1/m; 0: nothing known
float filling;                // of what is narrow or has holes and is seen in its middle; 0: nothing
float filling_placement;      // of it; 0: it has holes

void find_nearest(ivec2 pixel) {
    middle = push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset;
    [[unroll]] for (uint i = 0u; i < kEdgeSamples; ++i) nearest[i] = 0.0;
    filling = 0.0;
    for (uint k = 0u; k < 9u; ++k) {
        const ivec2 at = pixel + neighbour(k);
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(push.size)))) continue;
        const uvec2 triangle = imageLoad(triangles, at).rg;
        if (triangle.r == 0u) continue;
        const SeenFacet facet = facet_of(triangle, vec2(neighbour(k)));
        if (facet.mask != 0.0 || facet.narrow) {
            if (k == 0u) filling = 1.0 / imageLoad(surface_image, pixel).z, filling_placement = facet.mask != 0.0 ? 0.0 : facet.placement;
            continue;
        }
        [[unroll]] for (uint i = 0u; i < kEdgeSamples; ++i) {
            const vec3 p = vec3(place_of(i), 1.0);
            nearest[i] = inside(facet, p) >= 0.0 ? max(nearest[i], dot(facet.inverse_depth, p)) : nearest[i];
        }
    }
}

struct Piece {
    vec3 luminance, inverse_depth;
    vec2 corner;  // of the pixel, px from its origin
    int first, count;
    float placement, widening, reach;
};

Piece piece_of(uint entry, ivec2 pixel) {
    const int at = int((entry & ~kCoversTile) * kTexelsPerSmallEmitter);
    const vec4 a = texel_at(emitters, at), b = texel_at(emitters, at + 1), c = texel_at(emitters, at + 2);
    return Piece(a.rgb, b.xyz, vec2(pixel) - c.xy, int(a.w), int(b.w), c.z, c.w, texel_at(emitters, at + 3).x);
}

float depth_at(Piece piece, uint i) { return dot(piece.inverse_depth, vec3(piece.corner + 0.5 + place_of(i), 1.0)); }

float within[kEdgeSamples];  // px by which points are within the silhouette last asked for; negative: outside

void find_within(Piece piece) {
    [[unroll]] for (uint i = 0u; i < kEdgeSamples; ++i) within[i] = 1e30;
    vec2 a = texel_at(silhouettes, piece.first + piece.count - 1).xy;
    for (int v = 0; v < piece.count; ++v) {
        const vec2 b = texel_at(silhouettes, piece.first + v).xy, along = (b - a) / max(distance(a, b), 1e-30);
        [[unroll]] for (uint i = 0u; i < kEdgeSamples; ++i) {
            const vec2 p = piece.corner + 0.5 + place_of(i) - a;
            within[i] = min(within[i], along.x * p.y - along.y * p.x);
        }
        a = b;
    }
}

// The part of a silhouette within the pixel that nothing hides: of the points in it; where there is none, what the closest sees.
float seen_part(Piece piece) {
    const float rounding = 1.0 + kInFront, here = dot(piece.inverse_depth, vec3(piece.corner + 0.5, 1.0));
    const bool is_listed = filling_placement == piece.placement && filling * (1.0 - piece.reach * here) <= here;
    if (filling > rounding * here && !is_listed) return 0.0;
    find_within(piece);
    float points = 0.0, seen = 0.0, closest = -1e30, seen_closest = 0.0;
    [[unroll]] for (uint i = 0u; i < kEdgeSamples; ++i) {
        const float sees = nearest[i] > rounding * depth_at(piece, i) ? 0.0 : 1.0;
        points += within[i] >= 0.0 ? 1.0 : 0.0;
        seen += within[i] >= 0.0 ? sees : 0.0;
        seen_closest = within[i] > closest ? sees : seen_closest;
        closest = max(closest, within[i]);
    }
    return points > 0.0 ? seen / points : seen_closest;
}

void main() {
    const uint number = gl_WorkGroupID.y * kTilesPerRow + gl_WorkGroupID.x;
    if (number >= push.tiles) return;
    const uvec4 tile = texel_at(tiles, int(number));
    const ivec2 pixel = ivec2(tile.xy * kLuminaireTile + gl_LocalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(push.size)))) return;

    bool is_covered = false;
    for (uint i = 0u; i < tile.w && !is_covered; ++i) {
        const Piece piece = piece_of(texel_at(entries, int(tile.z + i)).r, pixel);
        is_covered = piece.widening > 0.0 && coverage(piece.corner, piece.first, piece.count) > 0.0;
    }
    if (!is_covered) return;
    find_nearest(pixel);
    for (uint i = 0u; i < tile.w; ++i) {
        const Piece piece = piece_of(texel_at(entries, int(tile.z + i)).r, pixel);
        if (piece.widening > 1.0) continue;  // others hide what is behind them
        find_within(piece);
        [[unroll]] for (uint k = 0u; k < kEdgeSamples; ++k) nearest[k] = within[k] >= 0.0 ? max(nearest[k], depth_at(piece, k)) : nearest[k];
    }
    vec3 sum = vec3(0.0);
    float share = 0.0;  // of the pixel
    for (uint i = 0u; i < tile.w; ++i) {
        const Piece piece = piece_of(texel_at(entries, int(tile.z + i)).r, pixel);
        const float covered = piece.widening > 0.0 ? coverage(piece.corner, piece.first, piece.count) : 0.0;
        if (covered == 0.0) continue;
        const float seen = covered / piece.widening * seen_part(piece);
        sum += piece.luminance * seen;
        share += seen;
    }
    const vec4 scene = imageLoad(scene_image, pixel);
    imageStore(scene_image, pixel, vec4(scene.rgb + sum / max(share, 1.0), scene.a));
}
