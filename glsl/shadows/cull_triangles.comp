#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require

// Shadow maps, opaque triangles, one run per workgroup (shared/shadow_map.h). Those that cover no middle of a texel of their
// quadrant are left out, small ones are drawn here, and the others are listed for rasterizing: what a far lamp sees is mostly of
// a few texels or less, for which that takes much longer.

#include "texels.glsl"
#include "shared/shadow_map.h"
#include "shared/edges.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 2) const uint kOver = 0u;    // see nearer.glsl
layout(constant_id = 3) const uint kSmall = 16u;  // texels: triangles in boxes of that side are drawn here

TEXELS(0, vec2, vertices);
TEXELS(1, uint, indices);
layout(binding = 2, scalar) readonly buffer Rows { mat3x4 rows[]; };  // in its columns
layout(binding = 3, scalar) readonly buffer Runs { TriangleRun runs[]; };
layout(binding = 4, scalar) readonly buffer Quadrants { MapQuadrant quadrants[]; };
layout(binding = 5, scalar) buffer Draws { uint draws[]; };                    // VkDrawIndirectCommand
layout(binding = 6, scalar) writeonly buffer Large { LargeCorner large[]; };
layout(binding = 7, scalar) buffer Words { uint words[]; };                    // texels that are drawn, see nearer.glsl
TEXELS(8, vec4, maps);                                                         // of the lamps of the frame
layout(binding = 9, scalar) buffer Changed { uint changed[]; };

#include "quadrant.glsl"
#include "nearer.glsl"

// Texels: vertices are snapped to that when they are rasterized, and rounded before. What is drawn here is wider by that, so
// that no gap is left beside what is rasterized.
layout(constant_id = 1) const float kSnap = 1.0 / 256.0;

// Corners in the hemisphere, texels, and the texels of the quadrant whose middles they may cover.
struct InImage {
    vec2 corners[3];
    vec2 first, last;
};

// Of x and y in a quadrant; 0 where there are none.
vec2 signs_of(MapQuadrant quadrant) {
    return quadrant.y_sign == 0.0 ? vec2(0.0) : vec2(quadrant.zoom < 0.0 ? -1.0 : 1.0, quadrant.y_sign);
}

InImage in_image(InQuadrant at[3], MapQuadrant quadrant) {
    InImage image;
    [[unroll]] for (int k = 0; k < 3; ++k) image.corners[k] = (at[k].position.xy / at[k].position.w * 0.5 + 0.5) * float(quadrant.side);
    const vec2 low = min(image.corners[0], min(image.corners[1], image.corners[2]));
    const vec2 high = max(image.corners[0], max(image.corners[1], image.corners[2]));
    image.first = max(ceil(low - kSnap - 0.5), vec2(0.0));
    image.last = min(floor(high + kSnap - 0.5), vec2(float(quadrant.side) - 1.0));
    // A quadrant is the quarter between two diagonals that has the edge of this sign along x or y.
    const vec2 signs = signs_of(quadrant), edge = signs.x == signs.y ? vec2(signs.x, 0.0) : vec2(0.0, signs.x);
    const float middle = 0.5 * float(quadrant.side);
    image.first = mix(image.first, max(image.first, vec2(middle - 1.0)), greaterThan(edge, vec2(0.0)));
    image.last = mix(image.last, min(image.last, vec2(middle)), lessThan(edge, vec2(0.0)));
    return image;
}

// Of a row of texels those whose middles may lie within the edges: the first and the last.
vec2 span_of(vec3 edges[3], vec3 per_x, float y, InImage image) {
    const float kRounding = 0.03;  // of a distance from an edge, times its length
    vec2 span = vec2(image.first.x, image.last.x);
    [[unroll]] for (int k = 0; k < 3; ++k) {
        const float end = -(edges[k].y * (y + 0.5) + edges[k].z + kRounding) * per_x[k] - 0.5;
        span.x = edges[k].x > 1e-3 ? max(span.x, end) : span.x;
        span.y = edges[k].x < -1e-3 ? min(span.y, end) : span.y;
    }
    return vec2(ceil(span.x), floor(span.y));
}

void draw_small(InImage image, InQuadrant at[3], MapQuadrant quadrant) {
    const vec2 a = image.corners[1] - image.corners[0], b = image.corners[2] - image.corners[0];
    const float area = a.x * b.y - a.y * b.x, turn = area < 0.0 ? -1.0 : 1.0;
    // Distances from the lines along the edges, of the texel's middle; not less than the margin inside.
    vec3 edges[3];
    [[unroll]] for (int k = 0; k < 3; ++k) {
        const vec2 from = image.corners[k], along = image.corners[(k + 1) % 3] - from;
        edges[k] = turn * vec3(-along.y, along.x, along.y * from.x - along.x * from.y);
        edges[k].z += kSnap * (abs(along.x) + abs(along.y) + kSnap);
    }
    const vec3 inverse = kMapNear / vec3(at[0].position.w, at[1].position.w, at[2].position.w);
    const float least = min(inverse.x, min(inverse.y, inverse.z)), most = max(inverse.x, max(inverse.y, inverse.z));
    if (abs(area) <= 1e-6) return;  // seen from its edge
    const float per_area = 1.0 / area;
    const vec2 rise = inverse.yz - inverse.x;
    const vec2 slope = per_area * vec2(rise.x * b.y - rise.y * a.y, rise.y * a.x - rise.x * b.x);
    const vec3 per_x = 1.0 / vec3(edges[0].x, edges[1].x, edges[2].x);
    const vec2 signs = signs_of(quadrant);
    const float centre = 0.5 * float(quadrant.side), overlap = quadrant.overlap * float(quadrant.side) * abs(quadrant.zoom);
    float y = image.first.y;
    vec2 span = span_of(edges, per_x, y, image);
    do {
        const vec2 texel = vec2(min(span.x, image.last.x), y), middle = texel + 0.5;
        const vec2 from_axis = middle - centre;
        bool covered = span.x <= span.y && min(signs.x * (from_axis.x + from_axis.y), signs.y * (from_axis.x - from_axis.y)) >= -overlap;
        [[unroll]] for (int k = 0; k < 3; ++k) covered = covered && dot(edges[k].xy, middle) + edges[k].z >= 0.0;
        const float value = clamp(inverse.x + dot(slope, middle - image.corners[0]), least, most);
        keep_nearer(covered, quadrant.first + uint(texel.y) * quadrant.side + uint(texel.x), value);
        const bool ends = !(span.x < span.y);
        y += ends ? 1.0 : 0.0;
        const vec2 next = span_of(edges, per_x, y, image);
        span = ends ? next : vec2(span.x + 1.0, span.y);
    } while (y <= image.last.y);
    if (kOver == 0u) return;
    for (uint corner = 0u; corner < 4u; ++corner)
        list_changed(quadrant.first, quadrant.side, uvec2((corner & 1u) == 0u ? image.first.x : image.last.x, corner < 2u ? image.first.y : image.last.y));
}

// `number`: of the quadrant.
void draw(uint number, MapQuadrant quadrant, vec3 q[3], InQuadrant at[3]) {
    // Of corners, texels, and of their distances: for the precision of edges and of depth.
    const float kFarthest = 8192.0, kDeepest = 64.0;
    const vec3 depths = vec3(at[0].position.w, at[1].position.w, at[2].position.w);
    const float nearest = min(depths.x, min(depths.y, depths.z)), farthest = max(depths.x, max(depths.y, depths.z));
    const InImage image = in_image(at, quadrant);
    const bool whole = nearest >= kMapNear;
    if (whole && any(greaterThan(image.first, image.last))) return;
    bool is_small = whole && farthest < kDeepest * nearest && all(lessThan(image.last - image.first, vec2(float(kSmall))));
    [[unroll]] for (int k = 0; k < 3; ++k) is_small = is_small && all(lessThan(abs(image.corners[k]), vec2(kFarthest)));
    if (is_small) {
        draw_small(image, at, quadrant);
        return;
    }
    const uint corner = atomicAdd(draws[0], 3u);
    [[unroll]] for (uint k = 0u; k < 3u; ++k) large[corner + k] = LargeCorner(q[k], number);
}

void main() {
    const TriangleRun run = runs[gl_WorkGroupID.x];
    const mat3x4 to_map = rows[run.rows];
    const MapQuadrant quadrant = quadrants[run.quadrant];
    const bool casts = quadrant.lamp == kCastsAlways || texel_at(maps, int(quadrant.lamp * kShadowMapTexels) + 1).y != 0.0;
    const uint triangles = casts ? run.triangles : 0u;
    for (uint triangle = gl_LocalInvocationID.x; triangle < triangles; triangle += gl_WorkGroupSize.x) {
        vec3 q[3];
        InQuadrant at[3];
        [[unroll]] for (uint k = 0u; k < 3u; ++k) {
            const int first = int((run.first_vertex + texel_at(indices, int(run.first_index + 3u * triangle + k)).r) * kTexelsPerVertex);
            const vec4 p = vec4(texel_at(vertices, first).xy, texel_at(vertices, first + 1).x, 1.0);
            q[k] = vec3(dot(to_map[0], p), dot(to_map[1], p), dot(to_map[2], p) * quadrant.mirror);
            at[k] = to_quadrant(q[k], quadrant);
        }
        bool out_of_sight = max(at[0].position.w, max(at[1].position.w, at[2].position.w)) < kMapNear;
        [[unroll]] for (int i = 0; i < 7; ++i)
            out_of_sight = out_of_sight || max(at[0].outside[i], max(at[1].outside[i], at[2].outside[i])) < 0.0;
        if (!out_of_sight) draw(run.quadrant, quadrant, q, at);
    }
}
