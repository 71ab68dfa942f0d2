#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Lists the pixels that see another facet than one of their eight neighbours does: no others can be at edges.

#include "shared/edges.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kRows = 1u;  // pixels of a column that an invocation does

layout(binding = 0, rg32ui) readonly uniform uimage2D triangles;
layout(binding = 1, scalar) buffer Counts { uint counts[]; };
layout(binding = 2, scalar) writeonly buffer Edges { uint edges[]; };
layout(push_constant, scalar) uniform Push { EdgesPush push; };

#include "edges_made.glsl"

// A pixel, and whether those to its left and right see the same.
struct Row {
    uvec2 middle;
    bool even;
};

Row row_at(ivec2 pixel) {
    const ivec2 last = ivec2(push.size) - 1;
    uvec2 seen[3];
    [[unroll]] for (int i = 0; i < 3; ++i) seen[i] = imageLoad(triangles, clamp(pixel + ivec2(i - 1, 0), ivec2(0), last)).rg;
    return Row(seen[1], seen[0] == seen[1] && seen[1] == seen[2]);
}

void main() {
    const ivec2 first = ivec2(gl_GlobalInvocationID.xy * uvec2(1u, kRows));
    Row above = row_at(first - ivec2(0, 1)), row = row_at(first);
    uint seams = 0u;  // a bit for each row
    for (uint r = 0u; r < kRows; ++r) {
        const ivec2 pixel = first + ivec2(0, r);
        const Row below = row_at(pixel + ivec2(0, 1));
        const bool even = above.even && row.even && below.even && above.middle == row.middle && below.middle == row.middle;
        seams |= !even && all(lessThan(pixel, ivec2(push.size))) ? 1u << r : 0u;
        above = row, row = below;
    }
    if (seams == 0u) return;
    uint place = take_places(uint(bitCount(seams)));
    do {
        list_edge(place, first + ivec2(0, findLSB(seams)));
        seams &= seams - 1u;
        ++place;
    } while (seams != 0u);
}
