// The last step: displayed light to codes of the display. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_ENCODE_H
#define VESPER_SHARED_ENCODE_H
#include "types.h"
SHARED_BEGIN

// Displayed light is relative: 0 at the display's darkest luminance, 1 at its brightest. Lights are sorted into cells by
// the leading bits of their floats, so cells are as wide as their light is large. A cell is a texel: the light from which
// on the code is b instead of g (r), the code below (g), the code above (b). At most one code begins inside a cell, so that
// codes are exact; where they lie closer than 1 / 4096 of their light it may be more.
struct EncodePush {
    uint shift;  // cell = clamp(bits >> shift, first, last) - first
    uint first;
    uint last;
    uint bits;   // of a channel's code
};
SHARED_SIZE(EncodePush, 16)

SHARED_END
#endif
