// Luminance pyramid and histogram. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_LUMINANCE_H
#define VESPER_SHARED_LUMINANCE_H
#include "types.h"
SHARED_BEGIN

// Texel (x, y) of level k covers the pixels [x 2^k, (x+1) 2^k) x [y 2^k, (y+1) 2^k) that exist, and holds
// r: mean luminance of its finite pixels, cd/m^2;  g: how many those are;
// b: mean of ln(max(luminance, log_floor) + log_epsilon);   a: largest luminance, cd/m^2.
struct PyramidPush {
    uvec2 from_size;    // texels of the level below
    uvec2 to_size;      // texels of this level: half, rounded up
    float log_floor;    // cd/m^2; used where the scene itself is read
    float log_epsilon;  // cd/m^2
    uint apart;         // 0; else, for texels that overlap: a texel is that of the level below and those so many before it, to_size is from_size + apart
};
SHARED_SIZE(PyramidPush, 28)

const uint kMaxBins = 256u;

struct HistogramPush {
    uvec2 image_size;   // px of the full image
    uvec2 level_size;   // texels of the level that votes
    uint level;
    uint bins;          // 1 .. kMaxBins
    float ln_low;       // ln of the luminance at the bottom of bin 0, cd/m^2; darker texels count there
    float bins_per_ln;  // bins per unit of ln luminance; brighter texels count in the last bin
    uint votes;         // of one pixel
    uint split;         // 1: votes are shared by the two bins whose middles are nearest, linearly; 0: one bin has them
    uint census;        // 1: this level also counts pixels
    uint overlap;       // a pixel is in 2^overlap texels, which share its votes
};
SHARED_SIZE(HistogramPush, 48)

// Zeroed every frame. Integers, so that the order of the votes does not matter. A texel stands for its finite pixels.
struct Histogram {
    uint finite;        // pixels; finite + non_finite are all of the image
    uint non_finite;    // pixels left out: NaN or infinite
    uint votes;         // sum of count
    uint count[kMaxBins];
};
SHARED_SIZE(Histogram, 1036)

const uint kColourTile = 32u;  // px, of the side of what colours are averaged over

struct ColoursPush {
    uvec2 size;   // px
    uvec2 tiles;  // size / kColourTile, rounded up
};
SHARED_SIZE(ColoursPush, 16)

const uint kAcuityLevels = 5u;  // of the pyramid that blur

struct AcuityPush {
    uvec2 size;               // px
    float pixels_per_degree;
    uint foveal_level;        // 1-based
    uint levels;              // that there are, at most kAcuityLevels
};
SHARED_SIZE(AcuityPush, 20)

SHARED_END
#endif
