// Illuminance of surfaces, cell by cell, as transport/radiosity.h solves for it. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_INDIRECT_H
#define VESPER_SHARED_INDIRECT_H
#include "types.h"
SHARED_BEGIN

// Cells lie in a table of rgba32ui texels, by a hash of their number and, where that is taken, the next free one after it
// (Knuth 1973, linear probing); the last is followed by the first. x: the number, y and z: red and green, and blue, as
// halves of kCellUnit lx, and above them in z a bit for each cell around that a wall hides, by rows from (-1, -1) to (1, 1)
// across the side, and a byte of the plane that cuts the cell (transport::CellCut); w: the height of the plane of their surfaces over the
// middle of the cube, along its normal, in cubes, a half, and above it the normal, octahedral, two signed bytes.
const uint kNoCell = 0xffffffffu;  // x of an empty place
const uint kCellHash = 2654435769u;  // times the number; its upper bits are the place
const float kCellUnit = 16.0f;       // lx
const uint kCellSides = 6u;          // of a cube: +x, -x, +y, -y, +z, -z
const uint kCellFacings = 18u;       // what surfaces face: these, and the ways between two, see transport::kFacings
const uint kCutSteps = 32u;          // along the way of a cut: its place is one of them; above them the bit of what is below
const float kDiagonal = 0.70710678f;  // of a way between two axes, along each

// Times the components of a normal along each axis before they are compared, see transport::kSideFactors.
const float kSideFactorX = 1.0002f, kSideFactorY = 1.0001f, kSideFactorZ = 1.0f;
const float kBetween = 0.414f;     // of the largest component, see transport::kBetween
const float kSameSurface = 0.75f;  // cubes: so far off the plane of a cell is another surface
const float kElsewhere = 1e-3f;    // weight of such
const float kLeastWeight = 1e-7f;  // of any cell

struct IndirectPush {
    uvec2 size;         // px
    vec2 ray_scale;     // as in ClusterGrid
    vec2 ray_offset;
    vec3 x_axis;        // from the view frame to cubes
    vec3 y_axis;
    vec3 z_axis;
    vec3 eye;
    vec3 cubes;         // along each axis, at most 2^24
    uint air_cubes;     // along each axis of a cube of air
    uint log2_places;   // of the table, at least 1
    float lambert;      // as in ShadePush
    vec3 sky_above;     // where no cell is near: on surfaces that face up, and down, lx; linear between them
    vec3 sky_below;
};
SHARED_SIZE(IndirectPush, 120)

// Of illuminance that is known for each pixel.
struct IlluminancePush {
    uvec2 size;       // px
    vec2 ray_scale;   // as in ClusterGrid
    vec2 ray_offset;
    float lambert;    // as in ShadePush
};
SHARED_SIZE(IlluminancePush, 28)

SHARED_END
#endif
