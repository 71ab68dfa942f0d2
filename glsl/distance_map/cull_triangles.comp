#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require

// Distance maps, opaque triangles: those that may cover the middle of a texel of a quadrant are kept, one per invocation
// (shared/distance_map.h). Most of what a far lamp sees is smaller than a texel, and rasterizing it takes longer than this.

#include "shared/distance_map.h"

layout(local_size_x = 32) in;  // kTrianglesOfRun

layout(binding = 0, scalar) readonly buffer Vertices { float vertices[]; };
layout(binding = 1, scalar) readonly buffer Indices { uint indices[]; };
layout(binding = 2, scalar) readonly buffer Rows { MapRows rows[]; };
layout(binding = 3, scalar) readonly buffer Runs { TriangleRun runs[]; };
layout(binding = 4, scalar) readonly buffer Quadrants { MapQuadrant quadrants[]; };
layout(binding = 5, scalar) buffer Draws { uvec4 draws[]; };              // VkDrawIndirectCommand, one for each quadrant
layout(binding = 6, scalar) writeonly buffer Triangles { float kept[]; };  // corners in the frame of the map, m
layout(push_constant, scalar) uniform Push { CullTrianglesPush push; };

#include "quadrant.glsl"

// Texels: vertices are snapped to 1/256 when they are rasterized, and rounded before.
const float kSnap = 1.0 / 64.0;

bool covers_a_middle(InQuadrant at[3], float side) {
    vec2 p[3];
    [[unroll]] for (int k = 0; k < 3; ++k) p[k] = (at[k].position.xy / at[k].position.w * 0.5 + 0.5) * side;
    const vec2 low = min(p[0], min(p[1], p[2])), high = max(p[0], max(p[1], p[2]));
    const vec2 first = ceil(low - kSnap - 0.5), last = floor(high + kSnap - 0.5);
    if (any(greaterThan(first, last))) return false;
    if (any(lessThan(first, last))) return true;
    // A single one, outside of an edge?
    const vec2 middle = first + 0.5;
    const vec2 a = p[1] - p[0], b = p[2] - p[0];
    const float turn = a.x * b.y - a.y * b.x < 0.0 ? -1.0 : 1.0;
    bool inside = true;
    [[unroll]] for (int k = 0; k < 3; ++k) {
        const vec2 edge = p[(k + 1) % 3] - p[k], to = middle - p[k];
        inside = inside && turn * (edge.x * to.y - edge.y * to.x) >= -kSnap * (abs(edge.x) + abs(edge.y) + kSnap);
    }
    return inside;
}

void main() {
    const TriangleRun run = runs[gl_WorkGroupID.x];
    const uint triangle = gl_LocalInvocationID.x;
    if (triangle >= run.triangles) return;
    const MapRows to_map = rows[run.rows];
    const MapQuadrant quadrant = quadrants[run.quadrant];
    vec3 q[3];
    InQuadrant at[3];
    [[unroll]] for (uint k = 0u; k < 3u; ++k) {
        const uint word = (run.first_vertex + indices[run.first_index + 3u * triangle + k]) * push.vertex_words;
        const vec4 p = vec4(vertices[word], vertices[word + 1u], vertices[word + 2u], 1.0);
        q[k] = vec3(dot(to_map.x, p), dot(to_map.y, p), dot(to_map.z, p) * quadrant.mirror);
        at[k] = to_quadrant(q[k], quadrant.place, quadrant.window, quadrant.y_sign);
    }
    bool out_of_sight = max(at[0].position.w, max(at[1].position.w, at[2].position.w)) < kMapNear;
    [[unroll]] for (int i = 0; i < 7; ++i)
        out_of_sight = out_of_sight || max(at[0].outside[i], max(at[1].outside[i], at[2].outside[i])) < 0.0;
    if (out_of_sight) return;
    const bool before = min(at[0].position.w, min(at[1].position.w, at[2].position.w)) > 0.0;
    if (before && !covers_a_middle(at, quadrant.side)) return;
    const uint vertex = quadrant.first * 3u + atomicAdd(draws[run.quadrant].x, 3u);
    [[unroll]] for (uint k = 0u; k < 3u; ++k)
        [[unroll]] for (int c = 0; c < 3; ++c) kept[3u * (vertex + k) + uint(c)] = q[k][c];
}
