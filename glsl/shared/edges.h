// Pixels that several surfaces fill: what the passes are told. Included by GLSL and by C++. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_EDGES_H
#define VESPER_SHARED_EDGES_H
#include "types.h"
SHARED_BEGIN

// Of n points of a pixel point i is at ((i + 1/2) / n, the bits of i in reverse / m + 1 / 2m), with m = 16, or 8 or 4 where n is
// no more; and these are most.
const uint kEdgeSamples = 16u;
const uint kEdgesPerGroup = 256u;    // pixels that a workgroup does
const uint kMostEdgeGroups = 65535u; // of which every device can run as many; further pixels stay as they are

// Two pixels see one surface if they see one region of one instance, whose normal turns by less between them,
const float kSameNormal = 0.9f;      // cosine
const float kSamePlane = 2e-4f;      // and are by no more off each other's plane than that bend, and so much of their depth

// Surfaces of less contrast in every channel have no edge.
const float kSameLuminance = 0.02f;

// Words of the list of edges: arguments of its dispatches, then how many there are.
const uint kEdgeCounts = 4u;

const uint kTexelsPerVertex = 6u;   // of rg32f, in which a vertex lies; its position begins with the first
const uint kUvTexel = 3u;

// The facet of the triangle that a vertex is the first of.
struct Facet {
    uint others[3];  // its other corners, in turn; of a triangle the third twice
    uint region;     // a number that triangles of its part share over whose common edges colours go on
};
SHARED_SIZE(Facet, 16)

struct EdgesPush {
    uvec2 size;       // px
    vec2 ray_scale;   // pixel (x, y) sees along (ray_scale (pixel + 1/2) + ray_offset, -1)
    vec2 ray_offset;
};
SHARED_SIZE(EdgesPush, 24)

SHARED_END
#endif
