// A lamp as the shaders see it, in the view frame (x right, y up, looking along -z). SPDX-License-Identifier: MIT
// Lamps are kept sorted by kind, so that every kind has its own loop: cones (points and spots), cosine powers, measured
// distributions (tables), directional lamps.
#ifndef VESPER_SHARED_LAMP_H
#define VESPER_SHARED_LAMP_H
#include "tables.h"
SHARED_BEGIN

// Read as a texel buffer of six rgba32f texels per lamp; the last three are for tables alone.
struct Lamp {
    vec3 position;    // m; directional: unused
    float intensity;  // on the axis, cd; table: the largest, cd; directional: illuminance facing the lamp, lx
    vec3 axis;        // unit vector along which the lamp shines; table: unused
    float lobe_a;     // cone: slope of the squared ramp in cos(angle); cosine power: exponent; table: unused
    vec3 colour;      // linear RGB of luminance 1
    float lobe_b;  // cone: offset of the ramp, I = intensity * clamp(a cos + b, 0, 1)^2; table: last cell of the polar
                   // angle
    vec3 start;    // unit vectors of the measurement: azimuth 0, and the pole
    float table;   // texel of the first cell, in the buffer of all tables
    vec3 pole;
    float last_azimuth;  // last cell of azimuth, which runs towards cross(start, pole); negative: the other way
    vec4 grid;           // cell = angle * (x, z) + (y, w) for azimuth (-pi to pi) and polar angle (0 to pi), rad
};
SHARED_SIZE(Lamp, 96)

const uint kTexelsPerLamp = 6u;

// How many lamps of each kind follow one another.
struct LampCounts {
    uint cones;
    uint powers;
    uint tables;
    uint directional;
};
SHARED_SIZE(LampCounts, 16)

SHARED_END
#endif
