// Visibility of lamps from blocks of pixels. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_VISIBILITY_H
#define VESPER_SHARED_VISIBILITY_H
#include "distance_map.h"
#include "shade.h"
SHARED_BEGIN

struct VisibilityPush {
    ClusterGrid grid;
    uvec2 size;       // px
    uint blocks_x;    // as in CullPush
    uint blocks_y;
    uint capacity;
};
SHARED_SIZE(VisibilityPush, 60)

// Pairs of a block and a lamp on its list; zeroed every frame.
struct VisibilityReport {
    uint lit;      // all of the block sees the lamp
    uint dark;     // nothing of it does: the lamp left the list
    uint mixed;    // is looked up pixel by pixel
};
SHARED_SIZE(VisibilityReport, 12)

SHARED_END
#endif
