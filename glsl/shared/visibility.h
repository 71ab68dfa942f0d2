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
};
SHARED_SIZE(VisibilityPush, 80)

// Pairs of a block and a lamp on its list; zeroed every frame.
struct VisibilityReport {
    uint lit;      // all of the block sees the lamp
    uint dark;     // nothing of it does: the lamp left the list
    uint mixed;    // some of it does, told pixel by pixel
    uint faint;    // some of it does, and the lamp gives so little that the mean serves
};
SHARED_SIZE(VisibilityReport, 16)

SHARED_END
#endif
