// Means of several samples of a pixel: what the passes are told. Included by GLSL and by C++. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_SAMPLES_H
#define VESPER_SHARED_SAMPLES_H
#include "types.h"
SHARED_BEGIN

struct SamplesPush {
    uvec2 size;     // px
    uint first;     // 1: of the samples to be added; there is no sum yet
    float samples;  // that were added
};
SHARED_SIZE(SamplesPush, 16)

SHARED_END
#endif
