// Photometric shading. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_SHADE_H
#define VESPER_SHARED_SHADE_H
#include "cluster.h"
SHARED_BEGIN

// What the reflectance image holds in place of metallic where the surface is of another kind: -1 - k for a road with
// table k. There, its colour is what it reflects of light from all sides seen at 1 degree, pi Qd (times the texture over its mean),
// and its roughness minus how much of that it is without sheen. kRetroCode + k of shared/retro.h for a
// retroreflective surface of class k, a dielectric otherwise.
const float kRoadKind = -1.0;

const uint kBlockSize = 8u;        // px, side of a block; a tile is a whole number of blocks
const uint kBlockCapacity = 512u;  // lamps of a block; more, and its pixels evaluate all lamps

// A block of pixels has a list of its own: the lamps of its froxels that can light what is drawn
// in it. An entry is a lamp's index and, above it, the share of the lamp that the block sees on average, in sixteenths (0:
// all of it), or with kMixedBit the place that has the shares of its pixels; and the first and the last slice whose pixels
// it is for.
const uint kShareShift = 15u;
const uint kShareMask = 31u;
const uint kShares = 16u;
const uint kMixedBit = 1u << 21u;
// Place k of a block: a word for each column of pixels, from word (block * kSharePlaces + k) * kBlockSize on; four bits for
// each pixel, the first one lowest, in fifteenths of the lamp.
const uint kSharePlaces = 16u;
const uint kFirstSliceShift = 22u;
const uint kLastSliceShift = 27u;

struct ActiveClustersPush {
    ClusterGrid grid;
    uvec2 size;      // px
    uint blocks_x;   // blocks in a row
};
SHARED_SIZE(ActiveClustersPush, 52)

struct CullPush {
    ClusterPush view;
    uvec2 size;      // px
    uint blocks_x;   // blocks in a row
    uint capacity;   // entries of a block: cones from the front, cosine powers and tables from the back
};
SHARED_SIZE(CullPush, 80)

struct ShadePush {
    uvec2 size;             // px
    ClusterGrid grid;
    LampCounts lamps;
    float threshold;        // lx, as in ClusterPush: the same rule decides here
    float lambert;          // L = E * reflectance * lambert: 1/pi, or 1 for the paper's L = E R
    float emission_limit;   // emission is clamped to this, cd/m^2; infinite except for the LDR baseline
    vec3 ambient;           // illuminance on any surface, RGB of luminance lx
    vec3 sky;               // luminance where nothing is drawn, cd/m^2 RGB
    uint blocks_x;          // as in CullPush
    uint capacity;
    uint roads;             // texel of the first road table's head
    uint blocks;            // of the image
    uint block_class;       // the one to shade
};
SHARED_SIZE(ShadePush, 120)

SHARED_END
#endif
