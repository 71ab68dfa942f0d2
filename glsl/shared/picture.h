// Pictures of other renderers: what picture.comp is told. Included by GLSL and by C++. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_PICTURE_H
#define VESPER_SHARED_PICTURE_H
#include "types.h"
SHARED_BEGIN

struct PicturePush {
    uvec2 size;   // px
    float scale;  // cd/m^2 of a value of 1
};
SHARED_SIZE(PicturePush, 12)

SHARED_END
#endif
