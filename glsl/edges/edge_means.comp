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
#include "shared/edges.h"
#include "shared/gbuffer.h"

layout(local_size_x = kEdgesPerGroup) in;
layout(binding = 0, rg32ui) readonly uniform uimage2D triangles;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) readonly uniform image2D scene_image;
layout(binding = 3) uniform usamplerBuffer counts;
layout(binding = 4) uniform usamplerBuffer edges;
layout(binding = 5) uniform samplerBuffer instances;
layout(binding = 6) uniform samplerBuffer vertices;
layout(binding = 7) uniform usamplerBuffer facets;
layout(binding = 8, rgba32f) writeonly uniform imageBuffer means;
layout(push_constant, scalar) uniform Push { EdgesPush push; };

#include "edges.glsl"

const float kTriangleWidth = 0.5;  // of its least height: in the mean over the triangle

vec2 place_of(uint i) { return vec2((float(i) + 0.5) / 16.0, float(bitfieldReverse(i) >> 28u) / 16.0 + 1.0 / 32.0) - 0.5; }

vec4 row_x, row_y, row_z;  // of the instance
vec2 middle;               // the pixel sees along (middle, -1)

// A corner from the middle of the pixel, px, times its depth; and its depth, m.
vec3 corner(uint vertex) {
    const int at = int(vertex * kTexelsPerVertex);
    const vec4 p = vec4(texelFetch(vertices, at).xy, texelFetch(vertices, at + 1).x, 1.0);
    const float depth = -dot(row_z, p);
    return vec3((vec2(dot(row_x, p), dot(row_y, p)) - middle * depth) / push.ray_scale, depth);
}

// Linear over the pixel: the distance from the line through two places, px, to the right seen from the first.
vec3 line(vec3 a, vec3 b) {
    const vec3 n = cross(a, b);
    return n / max(length(n.xy), 1e-30);
}

// And the inverse of the depth of the plane through three, 1/m.
vec3 inverse_depth(vec3 a, vec3 b, vec3 c) { return (cross(a, b) + cross(b, c) + cross(c, a)) / dot(c, cross(a, b)); }

// Of a triangle over one of its edges, px. Where its tip is behind the eye it goes on.
float height(vec3 edge, vec3 tip) { return tip.z > 0.0 ? dot(edge, tip) / tip.z : 1e30; }

void main() {
    const uint number = gl_GlobalInvocationID.x;
    if (number >= texelFetch(counts, 3).r) return;
    const uint index = texelFetch(edges, int(number)).r;
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
        const int row = int((triangle.r - 1u) * kTexelsPerInstance);
        row_x = texelFetch(instances, row), row_y = texelFetch(instances, row + 1), row_z = texelFetch(instances, row + 2);
        const bool has_holes = texelFetch(instances, row + 3).y != 0.0;
        const uvec4 others = texelFetch(facets, int(triangle.g));
        const vec3 a = corner(triangle.g), b = corner(others.x), c = corner(others.y), d = corner(others.z);
        const vec3 inverse = inverse_depth(a, b, c);
        const float front = dot(c, cross(a, b)) + dot(d, cross(a, c)) < 0.0 ? -1.0 : 1.0;
        const vec3 ab = front * line(a, b), bc = front * line(b, c), da = front * line(d, a);
        const bool triangular = others.y == others.z;
        const vec3 cd = triangular ? vec3(0.0) : front * line(c, d);
        const vec3 there = vec3(neighbour(k), 1.0);
        const float width = triangular ? kTriangleWidth * min(min(height(ab, c), height(bc, a)), height(da, b)) : min(dot(ab + cd, there), dot(bc + da, there));
        const bool fills = has_holes || width < 1.0;
        if (fills && k != 0u) continue;
        const uint as = is_same(here, seen_at(at)) ? 0u : k;
        [[unroll]] for (uint i = 0u; i < kEdgeSamples; ++i) {
            const vec3 p = vec3(place_of(i), 1.0);
            const vec4 inside = vec4(dot(ab, p), dot(bc, p), dot(cd, p), dot(da, p));
            const float least = fills ? 0.0 : min(min(inside.x, inside.y), min(inside.z, inside.w));
            const float depth = fills ? -1.0 / here.position.z : dot(inverse, p);
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
    imageStore(means, int(number), vec4(sum, 1.0));
}
