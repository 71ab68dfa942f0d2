// From the scene to codes of the display. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_COMPOSITE_H
#define VESPER_SHARED_COMPOSITE_H
#include "encode.h"
#include "tone.h"
SHARED_BEGIN

// Displayed light is relative: 0 at the display's darkest luminance, 1 at its brightest, linear in between.
struct CompositePush {
    uvec2 size;           // px
    float display_low;    // cd/m^2
    float display_high;
    float bloom;      // gain of the bloom; 0: none
    EncodePush encode;    // of composite.comp only
    vec3 red, green, blue;  // of the display = dot(these, linear Rec. 709), where its primaries are others
    vec3 luminance;         // likewise: of each primary, over that of white
    vec3 cones_long, cones_middle, cones_short;  // responses of cones = dot(these, colour of the display), as in gamut.h but 1 to its white
};
SHARED_SIZE(CompositePush, 120)

SHARED_END
#endif
