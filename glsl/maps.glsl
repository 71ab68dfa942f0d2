// Reads measured intensities and road surfaces (shared/maps.h). Needs `samplerBuffer maps`.

#include "shared/maps.h"
#include "shared/photometry.h"

// atan on [0, 1], an odd polynomial fitted to it; wrong by at most 1.7e-6 rad.
float arctan(float q) {
    const float q2 = q * q;
    return q * (0.99997722 + q2 * (-0.33262283 + q2 * (0.19354035 + q2 * (-0.11642641 + q2 * (0.05264726 - q2 * 0.01171909)))));
}

// Within 1e-3 rad near 0 and pi, where a cosine tells little, and 4e-6 elsewhere.
float arccos(float cosine) {
    const float low = 1.0 - cosine, high = 1.0 + cosine;
    const float half_angle = arctan(sqrt(min(low, high) / max(low, high)));
    return 2.0 * (low > high ? kPi / 2.0 - half_angle : half_angle);
}

// Value in a cell of a map, between its corners.
float interpolate(vec4 corners, float u, float v) { return mix(mix(corners.x, corners.y, u), mix(corners.z, corners.w, u), v); }

// Relative intensity in a direction (of any length) given along azimuth 0, azimuth 90 degrees and the pole. Both angles
// come from one division, and none from an inverse cosine, which is rough near the pole.
float map_intensity(vec3 d, vec4 grid, float first, vec2 last) {
    const vec3 a = abs(d);
    const float h = sqrt(d.x * d.x + d.y * d.y);
    const float high1 = max(a.x, a.y), high2 = max(h, a.z);
    const float inverse = 1.0 / max(high1 * high2, 1e-30);
    const float octant = arctan(min(a.x, a.y) * high2 * inverse), half_quarter = arctan(min(h, a.z) * high1 * inverse);
    const float quadrant = a.y > a.x ? kPi / 2.0 - octant : octant, half_turn = d.x < 0.0 ? kPi - quadrant : quadrant;
    const float azimuth = d.y < 0.0 ? -half_turn : half_turn;
    const float quarter = h > a.z ? kPi / 2.0 - half_quarter : half_quarter, polar = d.z < 0.0 ? kPi - quarter : quarter;
    const vec2 at = vec2(azimuth, polar) * grid.xz + grid.yw;
    const vec2 cell = floor(clamp(at, vec2(0.0), last));
    const vec4 corners = texelFetch(maps, int(first + cell.x * (last.y + 1.0) + cell.y));
    return interpolate(corners, at.x - cell.x, at.y - cell.y);
}
