// Luminance pyramid and histogram. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_LUMINANCE_H
#define VESPER_SHARED_LUMINANCE_H
#include "types.h"
SHARED_BEGIN

// Texel (x, y) of level k covers the pixels [x 2^k, (x+1) 2^k) x [y 2^k, (y+1) 2^k) that exist, and holds
// r: mean luminance of its finite pixels, cd/m^2;  g: how many those are;
// b: mean of ln max(luminance, kLuminanceFloor);   a: largest luminance, cd/m^2.
struct PyramidPush {
    uvec2 from_size;  // texels of the level below
    uvec2 to_size;    // texels of this level: half, rounded up
};
SHARED_SIZE(PyramidPush, 16)

const uint kMaxBins = 256u;

struct HistogramPush {
    uvec2 image_size;   // px of the full image
    uvec2 level_size;   // texels of the foveal level
    uint level;
    uint bins;          // 1 .. kMaxBins
    float ln_low;       // ln of the luminance at the bottom of bin 0, cd/m^2; darker texels count there
    float bins_per_ln;  // bins per unit of ln luminance; brighter texels count in the last bin
};
SHARED_SIZE(HistogramPush, 32)

// Zeroed every frame. A texel votes with its finite pixels, so that finite + non_finite is the number of pixels.
struct Histogram {
    uint finite;
    uint non_finite;    // pixels left out: NaN or infinite
    uint count[kMaxBins];
};
SHARED_SIZE(Histogram, 1032)

SHARED_END
#endif
