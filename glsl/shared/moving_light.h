// What things that move change of the light between surfaces. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_MOVING_LIGHT_H
#define VESPER_SHARED_MOVING_LIGHT_H
#include "types.h"
SHARED_BEGIN

// A body hides light by its volume of occlusion (transport/moving_bodies.h). The places of all volumes are texels of
// rgba32ui: a word each for the place, the next along x, along y, and along both; 0 where there is none. A word says how
// much is hidden of the light on a surface that faces +x, -x, +y, -y, +z and -z, in parts of kMostHidden, each
// kHiddenBits wide, the first in the lowest.
const uint kHiddenBits = 5u;
const uint kMostHidden = 31u;
struct HidingBody {
    uvec4 pixels;   // that it may cover, the first and the end, which is beyond them
    vec2 depths;    // likewise, least and most, m
    vec2 unused;
    uvec4 volume;   // places along each axis; of all places the index of its first
    vec4 x, y, z;   // rows from the view frame to steps from the first place
};
SHARED_SIZE(HidingBody, 96)
const uint kBodyTexels = 6u;  // of rgba32ui

// A patch (transport/lamp_reflections.h) has kPatchTexels of rgba32f: where it is in the view frame, and its radius; the
// direction that it faces; RGB of its luminous intensity, cd. On a surface at the distance d it gives
// E = I cos cos / (d^2 + radius^2), which on its axis is the light of a disc of that radius.
const uint kPatchTexels = 3u;

struct MovingLightPush {
    uvec2 size;      // px
    vec2 ray_scale;  // as in ClusterGrid
    vec2 ray_offset;
    uint patches, bodies;
};
SHARED_SIZE(MovingLightPush, 32)

const uint kMostBodies = 32u;   // of a view
const uint kMostPatches = 32u;

SHARED_END
#endif
