// Whether a light may give the threshold somewhere in a volume: what may be said without looking at single points.

#include "shared/cluster.h"

const float kSlack = 1.001;  // float rounding never costs a light

// The cosines of the smallest and of the largest angle between a lamp's axis and the directions in which it sees a sphere.
vec2 cosines_to(vec3 position, vec3 axis, vec3 centre, float radius) {
    const vec3 to = centre - position;
    const float away = length(to);
    if (!(away > radius)) return vec2(1.0, -1.0);  // also where it is no number
    const float cosine = clamp(dot(axis, to) / away, -1.0, 1.0), sine = sqrt(1.0 - cosine * cosine);
    const float sin_half = radius / away, cos_half = sqrt(1.0 - sin_half * sin_half);
    const float nearest = cosine >= cos_half ? 1.0 : cosine * cos_half + sine * sin_half + 1e-4;
    const float farthest = cosine <= -cos_half ? -1.0 : cosine * cos_half - sine * sin_half - 1e-4;
    return clamp(vec2(nearest, farthest), -1.0, 1.0);
}

// Largest intensity towards the sphere relative to that on the axis. The lobes fall with the angle.
float largest_cone(float lobe_a, float lobe_b, float cosine) {
    const float ramp = clamp(lobe_a * cosine + lobe_b, 0.0, 1.0);
    return ramp * ramp;
}
float largest_power(float exponent, float cosine) { return cosine > 0.0 ? exp2(exponent * log2(cosine)) : 0.0; }

// Between the angles of two cosines nothing of a map is brighter.
float largest_map(samplerBuffer maps, float envelope, vec2 cosines) {
    const vec2 rings = min(floor(sqrt(max(0.5 - 0.5 * cosines, 0.0)) * float(kEnvelope)), float(kEnvelope) - 1.0);
    const int level = findMSB(uint(rings.y - rings.x) + 1u), row = int(envelope) + level * int(kEnvelope);
    return max(texelFetch(maps, row + int(rings.x)).r, texelFetch(maps, row + int(rings.y) + 1 - (1 << level)).r);
}

// Whether an intensity still gives the threshold at a distance, m.
bool reaches(float intensity, float nearest, float threshold) {
    return nearest <= 0.0 ? intensity > 0.0 : kSlack * intensity >= threshold * nearest * nearest;
}
