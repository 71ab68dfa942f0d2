// What things that move change of the light between surfaces. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_MOVING_LIGHT_H
#define VESPER_SHARED_MOVING_LIGHT_H
#include "types.h"
SHARED_BEGIN

// A body has kBodyTexels texels of rgba32f: three rows from the view frame to places of its volume of occlusion
// (transport/moving_bodies.h); the number of places along each axis, and the index of the first; the pixels that the
// volume covers: left, top, and right and bottom, which are beyond it. The places of all volumes are texels of rg32ui:
// what is hidden of the light on a surface that faces +x, -x, +y, -y, +z and -z, in 255ths, from the lowest byte of x on.
//
// A patch (transport/lamp_reflections.h) has kPatchTexels: where it is in the view frame, and its radius; the direction
// that it faces; RGB of its luminous intensity, cd; the pixels that it lights. On a surface at the distance d it gives
// E = I cos cos / (d^2 + radius^2), which on its axis is the light of a disc of that radius.
const uint kBodyTexels = 5u;
const uint kPatchTexels = 4u;
const uint kMostBodies = 32u;  // bits of a uint
const uint kMostPatches = 32u;

struct MovingLightPush {
    uvec2 size;       // px
    vec2 ray_scale;   // as in ClusterGrid
    vec2 ray_offset;
    uint bodies;
    uint patches;     // their texels come after those of the bodies
};
SHARED_SIZE(MovingLightPush, 32)

SHARED_END
#endif
