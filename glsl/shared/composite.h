// Glare of the display image, and the way to its codes. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_COMPOSITE_H
#define VESPER_SHARED_COMPOSITE_H
#include "encode.h"
#include "tone.h"
SHARED_BEGIN

const uint kGlareShrink = 4u;  // the LDR glare is blurred at a quarter of the resolution

// Displayed light is relative: 0 at the display's darkest luminance, 1 at its brightest, linear in between.
struct BrightPush {
    uvec2 size;           // px of the full image
    uvec2 small_size;     // texels: size / kGlareShrink, rounded up
    float display_low;    // cd/m^2
    float display_high;
    float threshold;      // light of its brightest channel from which a pixel glares
};
SHARED_SIZE(BrightPush, 28)

struct BlurPush {
    uvec2 size;    // texels
    uvec2 step;    // (1, 0) or (0, 1)
    uint radius;   // weights 0 .. radius, symmetric, summing to 1
};
SHARED_SIZE(BlurPush, 20)

struct CompositePush {
    uvec2 size;           // px
    float display_low;    // cd/m^2
    float display_high;
    float bloom;      // gain of the LDR glare; 0: none
    EncodePush encode;    // of composite.comp only
    vec3 red, green, blue;  // of the display = dot(these, linear Rec. 709), where its primaries are others
    vec3 luminance;         // likewise: of each primary, over that of white
    vec3 cones_long, cones_middle, cones_short;  // responses of cones = dot(these, colour of the display), as in gamut.h but 1 to its white
};
SHARED_SIZE(CompositePush, 120)

SHARED_END
#endif
