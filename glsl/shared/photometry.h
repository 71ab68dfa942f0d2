// Photometric constants of the whole engine. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_PHOTOMETRY_H
#define VESPER_SHARED_PHOTOMETRY_H
#include "types.h"
SHARED_BEGIN

const float kPi = 3.14159265358979f;

// Luminance of linear Rec. 709 (BT.709, D65): Y = kRed R + kGreen G + kBlue B; its X and Z. From the primaries and white
// (SMPTE RP 177).
const float kRed = 0.212639f, kGreen = 0.715169f, kBlue = 0.072192f;
const float kXRed = 0.412391f, kXGreen = 0.357584f, kXBlue = 0.180481f, kZRed = 0.019331f, kZGreen = 0.119195f, kZBlue = 0.950532f;
// Responses of long, middle and short cones to linear Rec. 709 (Estevez 1979, as Hunt and CIECAM97s have them, from XYZ).
const vec3 kLongCones = vec3(0.305696f, 0.622713f, 0.045286f);
const vec3 kMiddleCones = vec3(0.157763f, 0.769686f, 0.088070f);
const vec3 kShortCones = vec3(0.019331f, 0.119195f, 0.950532f);
// Scotopic luminance of light of which only the colour is known: Y (kScotopicSlope (1 + (Y + Z) / X) - kScotopicOffset)
// (Ward Larson et al. 1997); and what that gives for Rec. 709's white of 1 cd/m^2, scotopic cd/m^2.
const float kScotopicSlope = 1.33f, kScotopicOffset = 1.68f, kScotopicOfWhite = 2.57328f;
// Luminance below which cones see nothing, and from which rods do not count, cd/m^2 (Ward Larson et al. 1997).
const float kScotopicBelow = 0.00562f, kPhotopicFrom = 5.62f;

// Logarithms of luminance are taken of at least this, cd/m^2: below the dark-adapted rod threshold.
const float kLuminanceFloor = 1e-4f;

SHARED_END
#endif
