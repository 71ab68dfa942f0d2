// Saliency: what draws the eye. Included by GLSL and by C++. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_SALIENCY_H
#define VESPER_SHARED_SALIENCY_H
#include "types.h"
SHARED_BEGIN

// Levels of halving resolution as of the luminance pyramid: texels of 2^k x 2^k px. Centres are levels 2 to 4, surrounds
// lie 3 or 4 levels above, and maps have the texels of level 4 (Itti, Koch and Niebur 1998).
const uint kSaliencyFinest = 2u, kSaliencyMapLevel = 4u;

// Added to the luminance that a difference is compared with, cd/m^2: the least difference that a dark-adapted eye sees
// (Ward Larson, Rushmeier and Piatko 1997), so that far below it nothing stands out.
const float kDarkLight = 1.38e-3f;
// A pixel does not count as brighter in any channel, cd/m^2; the sun has 1.6e9.
const float kSaliencyBrightest = 1e12f;
// Maps are stretched to a greatest value of 1, but those that nowhere reach this contrast only as much as if they did:
// an eye sees contrasts from 0.002 to 0.01 on (Campbell and Robson 1968).
const float kLeastContrast = 0.01f;
// Local maxima below this part of the greatest do not count.
const float kLeastPeak = 0.1f;
// Gabor filters: texels of a period, their reach, and the standard deviation of the Gaussian in texels.
const float kGaborPeriod = 7.0f, kGaborDeviation = 7.0f / 3.0f;
const int kGaborReach = 4;

// Texel (x, y) of a level: mean luminance, cd/m^2; red-green and blue-yellow opponency; finite pixels.
struct SaliencyLevelPush {
    uvec2 from_size;  // texels of the level below, or px of the scene
    uvec2 to_size;
};
SHARED_SIZE(SaliencyLevelPush, 16)

struct OrientedPush {
    uvec2 size;  // texels
};
SHARED_SIZE(OrientedPush, 8)

// Maps lie in an image side by side for pairs of levels, and one below the other: intensity; the colours red, blue, green
// and yellow; orientation at 0, 45, 90 and 135 degrees.
struct ContrastPush {
    uvec2 map_size;       // texels of a map
    uvec2 centre_size;    // texels
    uvec2 surround_size;  // texels
    uint block;           // texels of the centre's level along a side of a texel of the map: 4, 2 or 1
    float ratio;          // side of a texel of the centre over that of the surround
    uint pair;            // of levels
};
SHARED_SIZE(ContrastPush, 36)

// Of promote.comp and combine.comp.
struct SaliencyMapsPush {
    uvec2 size;    // texels of a map
    uint columns;  // of maps; they are counted row by row
};
SHARED_SIZE(SaliencyMapsPush, 12)

// What combine.comp adds up: pairs of levels, orientations, conspicuities.
const uint kAddPairs = 0u, kAddOrientations = 1u, kAddConspicuities = 2u;

SHARED_END
#endif
