// Bands of contrast between levels of the luminance pyramid. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_BANDS_H
#define VESPER_SHARED_BANDS_H
#include "types.h"
SHARED_BEGIN

// The topmost level, one below it, or pixels.
const uint kBandTop = 0u, kBandMiddle = 1u, kBandFinest = 2u;

struct BandsPush {
    uvec2 size;         // texels of the level, or px
    uvec2 above_size;   // texels of the level above
    float cone_break;   // log10 L from which Weber's law holds
    float viewer_sigma; // as of ToneParameters
    float viewer_step;  // as of ToneParameters
};
SHARED_SIZE(BandsPush, 28)

SHARED_END
#endif
