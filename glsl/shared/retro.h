// Retroreflective materials as the shaders see them. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_RETRO_H
#define VESPER_SHARED_RETRO_H
#include "types.h"
SHARED_BEGIN

// The G-buffer's metallic of a retroreflective surface is kRetroCode + its class; its base is a dielectric.
const float kRetroCode = 2.0f;
const uint kRetroClasses = 8u;     // at most
const uint kRetroRamps = 8u;       // of each angle
const float kRetroLeastCosine = 0.05f;
const float kRetroLeast = 1e-6f;   // cd/(lx m^2), a hundred-thousandth of what a dark wall reflects: beyond, nothing is added

// Read as a texel buffer of rgba32f texels, kRetroTexels per class: kRetroRamps ramps, then a RetroBase. A curve is its first
// value and the sum of slope * clamp(x - start, 0, length) over its ramps, so that looking it up takes no search.
struct RetroRamp {
    float observation;       // start, rad; the length is to the next ramp's, endless for the last
    float observation_slope; // of log2 of the coefficient, 1/rad
    float entrance;          // start, a cosine, descending; the length is to the next one's, down to 0 for the last
    float entrance_slope;    // of the factor, per unit of falling cosine
};
SHARED_SIZE(RetroRamp, 16)

struct RetroBase {
    float log2_coefficient;  // at the first angle, cd/(lx m^2)
    float entrance_factor;   // at the first angle
    float sheet;             // 1: R_A, luminance is over the cosine of view; 0: R_L
    float chord2;            // square of the chord between directions to lamp and eye where the coefficient is kRetroLeast
};
SHARED_SIZE(RetroBase, 16)

const uint kRetroTexels = kRetroRamps + 1u;

SHARED_END
#endif
