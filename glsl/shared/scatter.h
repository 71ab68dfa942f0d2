// Light scattered in the eye, see perception/scatter_fit.h. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_SCATTER_H
#define VESPER_SHARED_SCATTER_H
#include "types.h"
SHARED_BEGIN

// Texels of margin on every side of a level on the way up (means), and on the way down (what is scattered).
const uint kScatterUpMargin = 8u, kScatterDownMargin = 2u;

// Taps of a level, in texels of four: 13 at full resolution, 5 elsewhere, the rest being 0.
const uint kScatterFineTexels = 4u, kScatterCoarseTexels = 2u;

struct ScatterUpPush {
    uvec2 from_size;  // px of the picture, or texels of the level below with its margin
    uvec2 to_size;    // texels of this level with its margin
    uint lamps;       // outside the picture, whose light begins at this level: two texels each, place in texels and light
};
SHARED_SIZE(ScatterUpPush, 20)

struct ScatterTopPush {
    uvec2 size;       // texels of the top, without margin
};
SHARED_SIZE(ScatterTopPush, 8)

struct ScatterDownPush {
    uvec2 size;       // texels of what is made: the picture, or the level with its margin
    uvec2 nodes;      // places where taps are given, evenly from edge to edge of the picture
    uint node_texels; // of all levels at a node
    uint first_texel; // of this level
    vec2 scale;       // from texels of this level to nodes
};
SHARED_SIZE(ScatterDownPush, 32)

SHARED_END
#endif
