// What things that move change of the light between surfaces. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_MOVING_LIGHT_H
#define VESPER_SHARED_MOVING_LIGHT_H
#include "types.h"
SHARED_BEGIN

// A body hides light by its volume of occlusion (transport/moving_bodies.h). The places of all volumes are texels of
// r32ui: what is hidden of the light on a surface that faces +x, -x, +y, -y, +z and -z, in parts of kMostHidden, each
// kHiddenBits wide, the first in the lowest.
const uint kHiddenBits = 5u;
const uint kMostHidden = 31u;
struct HiddenPush {
    uvec2 first_pixel, end_pixel;  // that it may cover; the end is beyond them
    vec2 depths;                   // likewise, least and most, m
    vec2 ray_scale;                // as in ClusterGrid
    vec2 ray_offset;
    vec4 x, y, z;                  // rows from the view frame to steps from the first place
    uvec4 volume;                  // places along each axis; of all places the index of its first
};
SHARED_SIZE(HiddenPush, 104)

// A patch (transport/lamp_reflections.h) has kPatchTexels of rgba32f: where it is in the view frame, and its radius; the
// direction that it faces; RGB of its luminous intensity, cd. On a surface at the distance d it gives
// E = I cos cos / (d^2 + radius^2), which on its axis is the light of a disc of that radius.
const uint kPatchTexels = 3u;
struct PatchesPush {
    uvec2 size;  // px
    vec2 ray_scale;
    vec2 ray_offset;
    uint patches;
};
SHARED_SIZE(PatchesPush, 28)

const uint kMostBodies = 32u;   // of a view
const uint kMostPatches = 32u;

SHARED_END
#endif
