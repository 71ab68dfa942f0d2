// Clipmaps: how far light of a directional lamp comes. SPDX-License-Identifier: MIT
// Around the eye lie squares across the light, the levels, each twice as wide as the one before, as in a clipmap (Tanner,
// Migdal and Jones 1998). A texel holds the distance along the light, m, from the plane of its level (see middle below) to the
// first surface along its middle, as a half; kMapFar of shared/shadow_map.h without one. A level is side x side texels; the
// levels of a lamp follow one another.
#ifndef VESPER_SHARED_DIRECTIONAL_MAP_H
#define VESPER_SHARED_DIRECTIONAL_MAP_H
#include "shadow_map.h"
#include "shade.h"
SHARED_BEGIN

const uint kClipmapLevels = 8u;            // at most
const uint kClipmapTexels = 10u;           // rgba32f per lamp, see Clipmap
const float kFirstHalfWidth = 16.0;        // m, of the first level: half the side of its square
const float kLevelStep = 0.125;            // half widths: a level moves with the eye in such steps
const float kPenumbraReach = 256.0;        // m: penumbrae of what is farther from the lit surface are no wider
const uint kSharesPerWord = 4u;            // lamps, 8 bits each

// The maps of a directional lamp, as a frame sees it.
struct Clipmap {
    vec4 rotation; // quaternion from the view frame to that of the map: z is the way the light goes
    float first;   // texel of the first level, in units of kMapUnit
    float radius;  // tangent of half the angle that the lamp takes in the sky
    float unused_a, unused_b;
    vec4 middle[kClipmapLevels];  // of each level's square, relative to the eye, m; w unused
};
SHARED_SIZE(Clipmap, 160)

struct StoreClipmapPush {
    uint first;    // texel
    uint side;     // texels
    float farthest;   // m, distance along the light from the level's plane at a depth of 0
    float range;      // m, from there to that of a depth of 1, nearer to the lamp
};
SHARED_SIZE(StoreClipmapPush, 16)

// Shares of a pixel: word (block * words + lamp / kSharesPerWord) * 64 + 8 row + column, in 255ths of the lamp.
struct DirectionalVisibilityPush {
    ClusterGrid grid;
    uvec2 size;      // px
    uint blocks_x;   // as in CullPush
    uint lamps;
    uint levels;
    uint side;       // texels
};
SHARED_SIZE(DirectionalVisibilityPush, 64)

SHARED_END
#endif
