// Where masked surfaces have holes. Included by GLSL and by C++. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_MASKS_H
#define VESPER_SHARED_MASKS_H
#include "types.h"
SHARED_BEGIN

// A buffer of words: a Mask for each, from number 1, then their levels. A word of a level is that of a texel: its opacity, that of
// the texel to its right, of the one below, and of the one to the right of that, as the texture wraps, a byte each.
const uint kMostMaskLevels = 12u;
const uint kMostMaskSide = 2048u;  // texels: of larger textures there are the smaller levels alone

struct Mask {
    uint size;                 // of its first level, texels: width, and height times 65536
    uint kind;                 // kMask... of u, of v times 4, and kMaskNearest; levels times 256
    float cutoff;              // the least opacity of what is no hole, above 0
    uint at[kMostMaskLevels];  // first words of levels
};
const uint kWordsPerMask = 3u + kMostMaskLevels;
SHARED_SIZE(Mask, 4u * kWordsPerMask)
const uint kMaskRepeats = 0u, kMaskMirrors = 1u, kMaskEnds = 2u;
const uint kMaskNearest = 16u;  // magnified without interpolation

SHARED_END
#endif
