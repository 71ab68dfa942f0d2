#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// The mean luminance of the surfaces that fill a pixel. Which of them a point of the pixel sees is found from the facets that
// the pixel and its neighbours see in their middles: the nearest of those that cover it; where there is none, nothing if one of
// them sees nothing, else the closest. Its luminance is that of the middle that saw it. A facet that is narrower than a pixel,
// or has holes, fills the pixel whose middle sees it and no other: of such facets only some are seen, and so, in the mean over
// many, they keep their area.

#include "normal.glsl"
#include "texels.glsl"
#include "shared/edges.h"
#include "shared/gbuffer.h"

layout(local_size_x = kEdgesPerGroup) in;
layout(binding = 0, rg32ui) readonly uniform uimage2D triangles;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) readonly uniform image2D scene_image;
TEXELS(3, uint, counts);
TEXELS(4, uint, edges);
TEXELS(5, vec4, instances);
TEXELS(6, vec2, vertices);
TEXELS(7, uvec4, facets);
writeonly WRITTEN_TEXELS(8, vec4, means);
layout(push_constant, scalar) uniform Push { EdgesPush push; };

#include "edges.glsl"
#include "facets.glsl"

void main() {
    const uint number = gl_GlobalInvocationID.x;
    if (number >= texel_at(counts, 3).r) return;
    const uint index = texel_at(edges, int(number)).r;
    const ivec2 pixel = ivec2(index % push.size.x, index / push.size.x);
    middle = push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset;
    const Seen here = seen_at(pixel);

    float nearest[kEdgeSamples];  // inverse depth of what covers a point, 1/m; -1: nothing
    float closest[kEdgeSamples];  // px, negative: how far what does not cover it is
    uint which[kEdgeSamples];     // middle saw that
    [[unroll]] for (uint i = 0u; i < kEdgeSamples; ++i) nearest[i] = -1.0, closest[i] = -1e30, which[i] = 0u;
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
    while (seen_first != 0u) {
        const uint k = uint(findLSB(seen_first));
        seen_first &= seen_first - 1u;
        const ivec2 at = pixel + neighbour(k);
        const uvec2 triangle = imageLoad(triangles, at).rg;
        const SeenFacet facet = facet_of(triangle, vec2(neighbour(k)));
        const bool fills = facet.narrow || facet.has_holes;
        if (fills && k != 0u) continue;
        const uint as = is_same(here, seen_at(at)) ? 0u : k;
        [[unroll]] for (uint i = 0u; i < kEdgeSamples; ++i) {
            const vec3 p = vec3(place_of(i), 1.0);
            const float least = fills ? 0.0 : inside(facet, p);
            const float depth = fills ? -1.0 / here.position.z : dot(facet.inverse_depth, p);
            const bool covers = least >= 0.0 && depth > nearest[i];
            const bool closer = nearest[i] < 0.0 && least < 0.0 && least > closest[i] && depth > 0.0;
            nearest[i] = covers ? depth : nearest[i];
            closest[i] = closer ? least : closest[i];
            which[i] = covers || closer ? as : which[i];
        }
    }
    [[unroll]] for (uint i = 0u; i < kEdgeSamples; ++i) {
        if (nothing < 9u && nearest[i] < 0.0) which[i] = nothing;
    }

    vec3 sum = vec3(0.0);
    for (uint k = 0u; k < 9u; ++k) {
        float share = 0.0;
        [[unroll]] for (uint i = 0u; i < kEdgeSamples; ++i) share += which[i] == k ? 1.0 / float(kEdgeSamples) : 0.0;
        if (share > 0.0) sum += share * imageLoad(scene_image, pixel + neighbour(k)).rgb;
    }
    write_texel(means, int(number), vec4(sum, 1.0));
}
