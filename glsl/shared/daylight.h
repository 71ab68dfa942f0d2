// Light from everywhere, and the tunnels that it does not reach into. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_DAYLIGHT_H
#define VESPER_SHARED_DAYLIGHT_H
#include "types.h"
SHARED_BEGIN

// A tunnel is kTunnelTexels texels of rgba32f, in the view frame: the middle of its floor at one end and its length, the unit
// vector along it and half its width, the unit vector up and its height; m.
const uint kTunnelTexels = 3u;
const float kTunnelWall = 0.2f;  // m beyond floor, walls and ceiling that still are inside: their surfaces

struct DaylightPush {
    uvec2 size;        // px
    vec2 ray_scale;    // as in ClusterGrid
    vec2 ray_offset;
    vec3 illuminance;  // on any surface in the open, RGB of luminance lx
    float lambert;     // as in ShadePush
    uint tunnels;
};
SHARED_SIZE(DaylightPush, 44)

SHARED_END
#endif
