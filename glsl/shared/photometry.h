// Photometric constants of the whole engine. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_PHOTOMETRY_H
#define VESPER_SHARED_PHOTOMETRY_H
#include "types.h"
SHARED_BEGIN

const float kPi = 3.14159265358979f;

// Luminance of linear Rec. 709 (BT.709, D65): Y = kRed R + kGreen G + kBlue B.
const float kRed = 0.2126f, kGreen = 0.7152f, kBlue = 0.0722f;

// What rods see of linear Rec. 709, relative: white counts as its luminance (after Radiance; Larson et al. 1997).
const float kScotopicRed = 0.062f, kScotopicGreen = 0.608f, kScotopicBlue = 0.330f;
// Luminance below which cones see nothing, and from which rods do not count, cd/m^2 (Ward Larson et al. 1997).
const float kScotopicBelow = 0.00562f, kPhotopicFrom = 5.62f;

// Logarithms of luminance are taken of at least this, cd/m^2: below the dark-adapted rod threshold.
const float kLuminanceFloor = 1e-4f;

SHARED_END
#endif
