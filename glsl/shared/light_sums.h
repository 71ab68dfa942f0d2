// Sums of the light of a picture under tents, and those of some nodes. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_LIGHT_SUMS_H
#define VESPER_SHARED_LIGHT_SUMS_H
#include "types.h"
SHARED_BEGIN

// Tangents of a pixel, y up: scale * (pixel + 0.5) + offset.
struct LightSumsPush {
    uvec2 from, to;       // columns and rows of the level below, and of this one
    uint first_from;      // index of their first nodes among those from level 1 on
    uint first_to;
    vec2 scale;           // as in ClusterGrid
    vec2 offset;
    float pixel_area;     // of the plane one unit before the eye
};
SHARED_SIZE(LightSumsPush, 44)

struct LightNodesPush {
    uvec2 size;           // px
    uint nodes;
    vec2 scale;
    vec2 offset;
    float pixel_area;
};
SHARED_SIZE(LightNodesPush, 32)

SHARED_END
#endif
