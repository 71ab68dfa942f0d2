#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Lists the pixels that see another surface than one of their eight neighbours does, of another luminance. Where all that see
// other facets see the same surface, the pixel shows its own luminance whatever it is beside, and is not listed.

#include "normal.glsl"
#include "texels.glsl"
#include "shared/edges.h"

layout(local_size_x = kEdgesPerGroup) in;
layout(binding = 0, rg32ui) readonly uniform uimage2D triangles;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) readonly uniform image2D scene_image;
TEXELS(3, uint, seam_counts);
TEXELS(4, uint, seams);
TEXELS(5, uvec4, facets);
layout(binding = 6, scalar) buffer Counts { uint counts[]; };
layout(binding = 7, scalar) writeonly buffer Edges { uint edges[]; };
layout(push_constant, scalar) uniform Push { EdgesPush push; };

#include "edges.glsl"
#include "edges_made.glsl"

// The eight neighbours; beyond the border the pixel nearest to them.
ivec2 beside(ivec2 pixel, uint k) { return clamp(pixel + neighbour(k), ivec2(0), ivec2(push.size) - 1); }

void main() {
    const uint number = gl_GlobalInvocationID.x;
    if (number >= texel_at(seam_counts, 3).r) return;
    const ivec2 pixel = edge_at(texel_at(seams, int(number)).r);
    const uvec2 facet = imageLoad(triangles, pixel).rg;
    const Seen here = seen_at(pixel);
    const vec3 rgb = imageLoad(scene_image, pixel).rgb;
    uint left = 0u;  // neighbours that see other facets, a bit each
    [[unroll]] for (uint k = 1u; k < 9u; ++k) left |= imageLoad(triangles, beside(pixel, k)).rg != facet ? 1u << k : 0u;
    uint others = 0x1feu & ~left;
    bool edge = false, differs = false;
    // The loop begins with a turn: some neighbour of every seam differs, and a CPU device takes a turn for nothing otherwise.
    do {
        const ivec2 at = beside(pixel, uint(findLSB(left)));
        left &= left - 1u;
        const bool other = !is_same(here, seen_at(at));
        const vec3 change = abs(imageLoad(scene_image, at).rgb - rgb);
        differs = differs || other;
        edge = other && !all(lessThanEqual(change, kSameLuminance * abs(rgb)));
        // Of one facet two middles may see different surfaces: where it is bent, or seen at a glancing angle.
        if (left == 0u && differs) left = others, others = 0u;
    } while (left != 0u && !edge);
    if (edge) list_edge(take_places(1u), pixel);
}
