// Showing pictures and what lies over them in a window. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_PRESENT_H
#define VESPER_SHARED_PRESENT_H
#include "types.h"
SHARED_BEGIN

struct PresentPush {
    uvec2 size;     // of the picture, px
    vec2 origin;    // of its upper left corner in the window, px
    vec2 step;      // px of the picture per px of the window
    uint bits;      // of a channel: 8 or 10
    uint filtered;  // 0: the nearest pixel; 1: means weighted by a tent, two pixels wide on the coarser of both grids
};
SHARED_SIZE(PresentPush, 32)

struct OverlayPush {
    vec2 scale;     // clip space per px
    float white;    // cd/m^2 of what is white, in a HDR10 window
    uint hdr10;     // 1: colours become codes of SMPTE ST 2084 in Rec. 2020
};
SHARED_SIZE(OverlayPush, 16)

SHARED_END
#endif
