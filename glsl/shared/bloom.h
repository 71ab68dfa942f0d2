// Bloom of displayed light. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_BLOOM_H
#define VESPER_SHARED_BLOOM_H
#include "types.h"
SHARED_BEGIN

const uint kBloomShrink = 4u;  // bloom is blurred at a quarter of the resolution

struct BloomBrightPush {
    uvec2 size;           // px of the full image
    uvec2 small_size;     // texels: size / kBloomShrink, rounded up
    float display_low;    // cd/m^2
    float display_high;
    float threshold;      // light of its brightest channel from which a pixel glares
};
SHARED_SIZE(BloomBrightPush, 28)

struct BloomBlurPush {
    uvec2 size;    // texels
    uvec2 step;    // (1, 0) or (0, 1)
    uint radius;   // weights 0 .. radius, symmetric, summing to 1
};
SHARED_SIZE(BloomBlurPush, 20)

SHARED_END
#endif
