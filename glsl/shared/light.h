// A lamp as the shaders see it, in the view frame (x right, y up, looking along -z). SPDX-License-Identifier: MIT
// Lights are kept sorted by kind, so that every kind has its own loop: cones (points and spots), cosine powers,
// directional lights. A later kind, measured distributions, takes `right` and `distribution`.
#ifndef VESPER_SHARED_LIGHT_H
#define VESPER_SHARED_LIGHT_H
#include "types.h"
SHARED_BEGIN

// Read as a texel buffer of four rgba32f texels per light.
struct Light {
    vec3 position;       // m; directional: unused
    float intensity;     // on the axis, cd; directional: illuminance facing the light, lx
    vec3 axis;           // unit vector along which the lamp shines
    float lobe_a;        // cone: slope of the squared ramp in cos(angle); cosine power: exponent
    vec3 colour;         // linear RGB of luminance 1
    float lobe_b;        // cone: offset of the ramp, I = intensity * clamp(a cos + b, 0, 1)^2
    vec3 right;          // unit vector, the horizontal of the lamp's own frame
    float distribution;  // index of a measured distribution; -1 without
};
SHARED_SIZE(Light, 64)

const uint kTexelsPerLight = 4u;

// How many lights of each kind follow one another.
struct LightCounts {
    uint cones;
    uint powers;
    uint directional;
};
SHARED_SIZE(LightCounts, 12)

SHARED_END
#endif
