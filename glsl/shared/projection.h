// What a projector shows of a picture: for projection.comp. Included by GLSL and by C++. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_PROJECTION_H
#define VESPER_SHARED_PROJECTION_H
#include "encode.h"
SHARED_BEGIN

// A pixel of the projector's picture.
struct ProjectedPixel {
    vec2 at;       // px of the rendered picture, from its top left; the middle of the first pixel is (0.5, 0.5)
    float factor;  // of the light there, 0 to 1; negative: nothing is drawn, and the display shows its darkest
};
SHARED_SIZE(ProjectedPixel, 12)

struct ProjectionPush {
    uvec2 size;     // px, of the projector's picture
    uvec2 picture;  // px, of the rendered one
    EncodePush encode;
};
SHARED_SIZE(ProjectionPush, 32)

SHARED_END
#endif
