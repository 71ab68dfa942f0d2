// Light scattered in the eye, see vision/scatter_fit.h. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_EYE_SCATTER_H
#define VESPER_SHARED_EYE_SCATTER_H
#include "types.h"
SHARED_BEGIN

// Texels of margin on every side of a level on the way up (means), and on the way down (what is scattered).
const uint kScatterUpMargin = 9u, kScatterDownMargin = 2u;

struct ScatterUpPush {
    uvec2 from_size;  // px of the picture, or texels of the level below with its margin
    uvec2 to_size;    // texels of this level with its margin
    uint lamps;       // outside the picture, whose light begins at this level: two texels each, place in texels and light
    uint beyond;      // 1: there is other light from outside, for each texel of this level, row by row; from level 2 on
};
SHARED_SIZE(ScatterUpPush, 24)

struct ScatterTopPush {
    uvec2 size;       // texels of the top, without margin
};
SHARED_SIZE(ScatterTopPush, 8)

struct ScatterDownPush {
    uvec2 size;       // texels of what is made: the picture, or the level with its margin
    uvec2 nodes;      // places where taps are given, evenly from edge to edge of the picture
    uint levels;      // that have taps at a node
    uint level;       // this one
    uint rows;        // of a strip that an invocation does, even
    vec2 scale;       // from texels of this level to nodes
};
SHARED_SIZE(ScatterDownPush, 36)

// Light that pixels near the border keep, EdgeLight in vision/scatter_fit.h.
struct ScatterEdgePush {
    uvec2 size;       // px
    uvec2 deep;       // columns and rows at either border, px
    uvec2 between;    // places between them
};
SHARED_SIZE(ScatterEdgePush, 24)

SHARED_END
#endif
