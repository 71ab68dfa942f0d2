// Reads measured intensities and road surfaces (shared/tables.h). Needs TEXELS tables.

#ifndef VESPER_TABLES_GLSL
#define VESPER_TABLES_GLSL
#include "shared/tables.h"
#include "shared/photometry.h"

// Polynomials fitted to the functions, wrong by at most 1.2e-5 and 5e-6 rad; a cosine in single precision adds up to 4e-4 rad
// where it is near 1 or -1.
float arctan(float q) {  // 0 to 1
    const float q2 = q * q;
    return q * (0.99986633 + q2 * (-0.33030477 + q2 * (0.18015921 + q2 * (-0.08515621 + q2 * 0.02084504))));
}
float arccos(float cosine) {
    const float c = abs(cosine);
    const float angle = sqrt(max(1.0 - c, 0.0)) * (1.57079153 + c * (-0.21428062 + c * (0.08563839 + c * (-0.03761823 + c * 0.00973297))));
    return cosine < 0.0 ? kPi - angle : angle;
}

// Value in a cell of a table, between its corners.
float interpolate(vec4 corners, float u, float v) { return mix(mix(corners.x, corners.y, u), mix(corners.z, corners.w, u), v); }

// From -pi to pi.
float azimuth_of(vec2 d) {
    const vec2 a = abs(d);
    const float octant = arctan(min(a.x, a.y) / max(max(a.x, a.y), 1e-30));
    const float quadrant = a.y > a.x ? kPi / 2.0 - octant : octant, half_turn = d.x < 0.0 ? kPi - quadrant : quadrant;
    return d.y < 0.0 ? -half_turn : half_turn;
}

// Azimuth 90 degrees of a measurement.
vec3 turn_of(vec3 start, vec3 pole, float last_azimuth) { return last_azimuth < 0.0 ? cross(pole, start) : cross(start, pole); }

// Relative intensity in a direction given along azimuth 0, azimuth 90 degrees and the pole, times its `inverse` length; and where that is, `at`, in cells.
float table_intensity(vec3 d, float inverse, vec4 grid, float first, vec2 last, out vec2 at) {
    at = vec2(azimuth_of(d.xy), arccos(d.z * inverse)) * grid.xz + grid.yw;
    const vec2 cell = floor(clamp(at, vec2(0.0), last));
    const vec4 corners = texel_at(tables, int(first + cell.x * (last.y + 1.0) + cell.y));
    return interpolate(corners, at.x - cell.x, at.y - cell.y);
}

#endif
