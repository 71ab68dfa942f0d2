#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// The mean luminance of the surfaces that fill a pixel. Which of them a point of the pixel sees is found from the facets that
// the pixel and its neighbours see in their middles: the nearest of those that cover it; where there is none, nothing if one of
// them sees nothing, else the closest. Its luminance is that of the middle that saw it. A facet that is narrower than a pixel,
// or has holes at unknown places, fills the pixel whose middle sees it and no other: of such facets only some are seen, and so, in
// the mean over many, they keep their area.

#include "normal.glsl"
#include "texels.glsl"
#include "shared/edges.h"
#include "shared/gbuffer.h"
#include "shared/masks.h"

layout(local_size_x = kEdgesPerGroup) in;
layout(constant_id = 0) const uint kPoints = kEdgeSamples;
layout(constant_id = 1) const uint kAnisotropy = 1u;  // of samplers of textures

layout(binding = 0, rg32ui) readonly uniform uimage2D triangles;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) readonly uniform image2D scene_image;
TEXELS(3, uint, counts);
TEXELS(4, uint, edges);
TEXELS(5, vec4, instances);
TEXELS(6, vec2, vertices);
TEXELS(7, uvec4, facets);
TEXELS(8, uint, masks);
writeonly WRITTEN_TEXELS(9, vec4, means);
layout(push_constant, scalar) uniform Push { EdgesPush push; };

const uint kAllPoints = (1u << kPoints) - 1u;

#include "edges.glsl"
#include "edges_list.glsl"
#include "facets.glsl"
#include "masks.glsl"

// For each point of the pixel which middle saw what is there: word b has bit b of the middles' numbers, a bit for each point.
uint which[4];

void give(uint points, uint middle_) {
    [[unroll]] for (uint b = 0u; b < 4u; ++b) which[b] = (which[b] & ~points) | ((middle_ >> b & 1u) != 0u ? points : 0u);
}

uint middle_of(uint point) {
    uint number = 0u;
    [[unroll]] for (uint b = 0u; b < 4u; ++b) number |= (which[b] >> point & 1u) << b;
    return number;
}

uint points_of(uint middle_) {
    uint points = kAllPoints;
    [[unroll]] for (uint b = 0u; b < 4u; ++b) points &= (middle_ >> b & 1u) != 0u ? which[b] : ~which[b];
    return points;
}

void main() {
    const uint number = gl_GlobalInvocationID.x;
    if (number >= texel_at(counts, 3).r) return;
    const ivec2 pixel = edge_at(texel_at(edges, int(number)).r);
    middle = push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset;
    const Seen here = seen_at(pixel);

    float nearest[kEdgeSamples];  // inverse depth of what covers a point, 1/m; -1: nothing
    float closest[kEdgeSamples];  // px, negative: how far what does not cover it is
    [[unroll]] for (uint i = 0u; i < kPoints; ++i) nearest[i] = -1.0, closest[i] = -1e30;
    [[unroll]] for (uint b = 0u; b < 4u; ++b) which[b] = 0u;
    // Each facet once: a bit for the first middle that sees it.
    uint seen_first = 0u, nothing = 9u;
    uvec2 known[9];
    [[unroll]] for (uint k = 0u; k < 9u; ++k) {
        const ivec2 at = pixel + neighbour(k);
        const bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(push.size)));
        known[k] = inside ? imageLoad(triangles, at).rg : known[0];
        bool is_new = known[k].r != 0u;
        [[unroll]] for (uint j = 0u; j < k; ++j) is_new = is_new && known[j] != known[k];
        seen_first |= is_new ? 1u << k : 0u;
        nothing = known[k].r == 0u ? min(nothing, k) : nothing;
    }
    // Each loop begins with a turn: something is seen beside every edge, and a CPU device takes a turn for nothing before it leaves
    // a loop that asks first.
    do {
        const uint k = uint(findLSB(seen_first));
        seen_first &= seen_first - 1u;
        const ivec2 there = neighbour(k);
        const SeenFacet facet = facet_of(imageLoad(triangles, pixel + there).rg, vec2(there));
        const bool fills = facet.narrow || facet.mask < 0.0;
        const uint holes = fills ? 0u : holes_of(facet, vec2(there));
        // Of those that fill their pixels only the pixel's own counts.
        const float filled = k == 0u ? 0.0 : -1e30;
        uint taken = 0u;
        [[unroll]] for (uint i = 0u; i < kPoints; ++i) {
            const vec3 p = vec3(place_of(i), 1.0);
            const float within = (holes >> i & 1u) != 0u ? -1e30 : inside(facet, p);
            const float least = fills ? filled : within;
            const float depth = fills ? -1.0 / here.position.z : dot(facet.inverse_depth, p);
            const bool covers = least >= 0.0 && depth > nearest[i];
            const bool closer = nearest[i] < 0.0 && least < 0.0 && least > closest[i] && depth > 0.0;
            nearest[i] = covers ? depth : nearest[i];
            closest[i] = closer ? least : closest[i];
            taken |= covers || closer ? 1u << i : 0u;
        }
        give(taken, k);
    } while (seen_first != 0u);
    uint bare = 0u;
    [[unroll]] for (uint i = 0u; i < kPoints; ++i) bare |= nothing < 9u && nearest[i] < 0.0 ? 1u << i : 0u;
    give(bare, nothing);

    // A middle of the same surface counts with the luminance of the pixel itself.
    vec3 sum = vec3(0.0);
    uint left = kAllPoints, own = 0u;
    do {
        const uint k = middle_of(uint(findLSB(left))), points = points_of(k);
        const ivec2 at = pixel + neighbour(k);
        left &= ~points;
        const bool same = k == 0u || (k != nothing && is_same(here, seen_at(at)));
        own += same ? uint(bitCount(points)) : 0u;
        if (!same) sum += float(bitCount(points)) / float(kPoints) * imageLoad(scene_image, at).rgb;
    } while (left != 0u);
    if (own != 0u) sum += float(own) / float(kPoints) * imageLoad(scene_image, pixel).rgb;
    write_texel(means, int(number), vec4(sum, 1.0));
}
