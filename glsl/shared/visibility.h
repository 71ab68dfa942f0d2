// Visibility of lamps from blocks of pixels. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_VISIBILITY_H
#define VESPER_SHARED_VISIBILITY_H
#include "shadow_map.h"
#include "shade.h"
SHARED_BEGIN

struct VisibilityPush {
    ClusterGrid grid;
    uvec2 size;       // px
    uint blocks_x;    // as in CullPush
    uint blocks_y;
    uint capacity;
    LampCounts lamps;
    float shadow_error; // of a block's light: lamps of less count with the mean of what the block sees of them
    float probe_error;  // likewise: of lamps of less all pixels see what the probes do, where these agree
};
SHARED_SIZE(VisibilityPush, 84)

// Pairs of a block and a lamp on its list; zeroed every frame.
struct VisibilityReport {
    uint lit;      // all of the block sees the lamp
    uint dark;     // nothing of it does: the lamp left the list
    uint mixed;    // some of it does, told pixel by pixel
    uint faint;    // some of it does, and the lamp gives so little that the mean serves
    uint unshadowed;       // lamps that shine through everything: they give too little light
    uint unshadowed_light; // their share of the light of the picture, in millionths
};
SHARED_SIZE(VisibilityReport, 24)

struct LightSharesPush {
    ClusterGrid grid;
    uvec2 size;       // px
    uint blocks_x;    // as in CullPush
    uint blocks_y;
    uint capacity;
    uint step;        // of step x step blocks one is taken
    LampCounts lamps;
    uint whole;       // what the light of one block counts as
};
SHARED_SIZE(LightSharesPush, 84)

struct CastingLampsPush {
    uint lamps;
    uint optional;     // as many may be left out, at least 1; one that is none of the lamps stands for none
    uint blocks;       // as many were taken
    uint whole;        // as in LightSharesPush
    float most_share;  // of the light, that lamps without shadows may give together
};
SHARED_SIZE(CastingLampsPush, 20)

SHARED_END
#endif
