// Photometric constants of the whole engine. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_PHOTOMETRY_H
#define VESPER_SHARED_PHOTOMETRY_H
#include "types.h"
SHARED_BEGIN

const float kPi = 3.14159265358979f;

// Luminance of linear Rec. 709 (BT.709, D65): Y = kRed R + kGreen G + kBlue B.
const float kRed = 0.2126f, kGreen = 0.7152f, kBlue = 0.0722f;

// X and Z of linear Rec. 709 (IEC 61966-2-1).
const float kXRed = 0.4124f, kXGreen = 0.3576f, kXBlue = 0.1805f, kZRed = 0.0193f, kZGreen = 0.1192f, kZBlue = 0.9505f;
// Responses of long, middle and short cones to linear Rec. 709 (Estevez 1979, as Hunt and CIECAM97s have them, from XYZ).
const vec3 kLongCones = vec3(0.305675f, 0.622740f, 0.045302f);
const vec3 kMiddleCones = vec3(0.157713f, 0.769720f, 0.088074f);
const vec3 kShortCones = vec3(0.0193f, 0.1192f, 0.9505f);
// Scotopic luminance of light of which only the colour is known: Y (kScotopicSlope (1 + (Y + Z) / X) - kScotopicOffset)
// (Ward Larson et al. 1997); and what that gives for Rec. 709's white of 1 cd/m^2, scotopic cd/m^2.
const float kScotopicSlope = 1.33f, kScotopicOffset = 1.68f, kScotopicOfWhite = 2.57306f;
// Luminance below which cones see nothing, and from which rods do not count, cd/m^2 (Ward Larson et al. 1997).
const float kScotopicBelow = 0.00562f, kPhotopicFrom = 5.62f;

// Logarithms of luminance are taken of at least this, cd/m^2: below the dark-adapted rod threshold.
const float kLuminanceFloor = 1e-4f;

SHARED_END
#endif
