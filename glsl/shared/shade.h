// Photometric shading. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_SHADE_H
#define VESPER_SHARED_SHADE_H
#include "cluster.h"
SHARED_BEGIN

struct ShadePush {
    uvec2 size;             // px
    ClusterGrid grid;
    LightCounts lights;
    float threshold;        // lx, as in ClusterPush: the same rule decides here
    float lambert;          // L = E * reflectance * lambert: 1/pi, or 1 for the paper's L = E R
    float emission_limit;   // emission is clamped to this, cd/m^2; infinite except for the LDR baseline
    vec3 ambient;           // illuminance on any surface, RGB of luminance lx
    vec3 sky;               // luminance where nothing is drawn, cd/m^2 RGB
    uint blocks_x;          // blocks of pixels, one per workgroup, in a row
    uint blocks;            // in all
    uint block_step;        // workgroup i does block (i block_step) mod blocks: spreads sky and road over the cores
};
SHARED_SIZE(ShadePush, 108)

SHARED_END
#endif
