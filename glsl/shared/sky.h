// A sky made ready for shading, and what its pass is told. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_SKY_H
#define VESPER_SHARED_SKY_H
#include "types.h"
SHARED_BEGIN

// Read as a texel buffer of rgba32f texels: kSkyPolynomial factors of the illuminance (photometry/environment.h), a
// table of kSpecularSide^2 reflected fractions (x: of F0, y: of F90; the root of n.v along rows, roughness down columns),
// kSkyLobes octahedral maps of the sky blurred by the lobes of roughness 1 / kSkyLobes ... 1, and the sharp one. Maps have
// a border of one texel.
const uint kSkyPolynomial = 9u;
const uint kSpecularSide = 32u;
const uint kSkyLobes = 5u;
const uint kSkyLobeSide = 64u;
const uint kSkyLobeTexels = (kSkyLobeSide + 2u) * (kSkyLobeSide + 2u);
const uint kSkyLobesStart = kSkyPolynomial + kSpecularSide * kSpecularSide;
const uint kSkySharpStart = kSkyLobesStart + kSkyLobes * kSkyLobeTexels;

struct SkyPush {
    uvec2 size;        // px
    vec2 ray_scale;    // as in ClusterGrid
    vec2 ray_offset;
    vec3 right;        // the axes of the view frame in the world
    vec3 up;
    vec3 back;
    float lambert;     // as in ShadePush
    uint sharp_side;   // texels of the sharp map, without its border
};
SHARED_SIZE(SkyPush, 68)

SHARED_END
#endif
