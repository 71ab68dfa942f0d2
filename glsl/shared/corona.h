// Needles and halo of the brightest lamps of a picture, see vision/glare_pattern.h. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_CORONA_H
#define VESPER_SHARED_CORONA_H
#include "types.h"
SHARED_BEGIN

const uint kCoronaTile = 16u;   // px, of the side of the squares whose light is one lamp
const uint kCoronaLamps = 32u;  // that have needles: the bits of one word

// The light of a square. Zero where there is none.
struct CoronaTile {
    vec3 light;       // sum over its pixels, cd/m^2 px
    float luminance;  // of that; the order of lamps
    vec2 place;       // px from the top left corner of the picture, mean of its light
    float spread;     // variance of its light about that, mean of both axes, px^2
};
SHARED_SIZE(CoronaTile, 28)

// A lamp as the eye sees it.
struct CoronaLamp {
    vec3 direction;   // from the eye, view frame, unit length
    float blur;       // square of the width of a box as wide as it is, a pixel included, rad^2
    vec3 light;       // RGB lx, times its share
    float unused;
};
SHARED_SIZE(CoronaLamp, 32)

struct CoronaPush {
    uvec2 size;       // px
    vec2 ray_scale;   // View::ray_scale, View::ray_offset
    vec2 ray_offset;
};
SHARED_SIZE(CoronaPush, 24)

// The pattern: what is seen beside the veil, sr^-1, times the square of the angle in degrees. Row by row: its columns, their means in pairs and over as
// many rows, and so on to the mean of all.
const uint kPatternColumns = 512u, kPatternRows = 448u, kPatternLevels = 10u;
const uint kPatternStride = 2u * kPatternColumns - 1u;  // texels of a row
const uint kPatternReach = 6u;  // degrees

SHARED_END
#endif
