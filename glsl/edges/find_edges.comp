#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Lists the pixels that see another surface than one of their eight neighbours does, of another luminance.

#include "normal.glsl"
#include "shared/edges.h"
#include "shared/photometry.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kRows = 1u;  // pixels of a column that an invocation does

layout(binding = 0, rg32ui) readonly uniform uimage2D triangles;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) readonly uniform image2D scene_image;
layout(binding = 3, scalar) buffer Counts { uint counts[]; };
layout(binding = 4, scalar) writeonly buffer Edges { uint edges[]; };
layout(push_constant, scalar) uniform Push { EdgesPush push; };

#include "edges.glsl"

// A pixel and those to its left and right.
struct Row {
    Seen seen[3];
    vec3 rgb[3];
};

Row row_at(ivec2 pixel) {
    const ivec2 last = ivec2(push.size) - 1;
    Row row;
    [[unroll]] for (int i = 0; i < 3; ++i) {
        const ivec2 at = clamp(pixel + ivec2(i - 1, 0), ivec2(0), last);
        row.seen[i] = seen_at(at);
        row.rgb[i] = imageLoad(scene_image, at).rgb;
    }
    return row;
}

bool differs(Seen here, vec3 rgb, Row row, int i) {
    const vec3 change = abs(row.rgb[i] - rgb);
    return !is_same(here, row.seen[i]) && !all(lessThanEqual(change, kSameLuminance * abs(rgb)));
}

void main() {
    const ivec2 first = ivec2(gl_GlobalInvocationID.xy * uvec2(1u, kRows));
    Row above = row_at(first - ivec2(0, 1)), row = row_at(first);
    for (uint r = 0u; r < kRows; ++r) {
        const ivec2 pixel = first + ivec2(0, r);
        const Row below = row_at(pixel + ivec2(0, 1));
        const Seen here = row.seen[1];
        const vec3 rgb = row.rgb[1];
        bool edge = differs(here, rgb, row, 0) || differs(here, rgb, row, 2);
        [[unroll]] for (int i = 0; i < 3; ++i) edge = edge || differs(here, rgb, above, i) || differs(here, rgb, below, i);
        above = row, row = below;
        if (!edge || any(greaterThanEqual(pixel, ivec2(push.size)))) continue;
        const uint place = atomicAdd(counts[3], 1u);
        if (place >= kEdgesPerGroup * kMostEdgeGroups) continue;
        if (place % kEdgesPerGroup == 0u) atomicAdd(counts[0], 1u);
        edges[place] = uint(pixel.y) * push.size.x + uint(pixel.x);
    }
}
