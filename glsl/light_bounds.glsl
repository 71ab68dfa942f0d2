// Whether a lamp may give the threshold somewhere in a volume: what may be said without looking at single points. Needs
// TEXELS lamps, TEXELS tables and the constants kPowers and kTables.

#include "tables.glsl"
#include "shared/cluster.h"
#include "shared/lamp.h"

const float kSlack = 1.001;  // float rounding never costs a lamp

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

// The shortest window (shared/tables.h) that holds bin `first` and `more` bins after it, of `count`.
int window_of(int first, int more, int count) {
    int level = more > 0 ? (floatBitsToInt(float(more)) >> 23) - 126 : 0;  // 2^level is more than that
    const int stride_bits = max(level - 1, 0);
    level += (first & (1 << stride_bits) - 1) + more >= 1 << level ? 1 : 0;
    return (level > 0 ? 3 * count - (4 * count >> level) : 0) + (first >> max(level - 1, 0));
}

// Nothing of a table is brighter towards the sphere around the end of `to`, which it sees at `cosines` to its pole. `start_table` and
// `pole_last`: texels 3 and 4 of the lamp.
float largest_table(vec3 to, vec2 cosines, vec4 start_table, vec4 pole_last, float radius) {
    const float kBlur = 1e-4;  // rad, of azimuth where it is known that well
    const vec2 rings = min(sqrt(max(0.5 - 0.5 * cosines, 0.0)) * float(kRings), float(kRings) - 0.5);
    const vec2 d = vec2(dot(start_table.xyz, to), dot(turn_of(start_table.xyz, pole_last.xyz, pole_last.w), to));
    const float across = length(d), away = length(to);
    // Near the pole it may have any azimuth.
    const bool around = !(across > max(radius, 0.01 * away));
    const float sine = radius / across;
    const float width = around ? kPi : sine * (1.0 + (kPi / 2.0 - 1.0) * sine * sine) + kBlur;  // at least its arcsine
    const float sector = (azimuth_of(d) - width) * (float(kSectors) / (2.0 * kPi)) + 1.5 * float(kSectors), sectors = width * (float(kSectors) / kPi);
    const int first = around ? 0 : int(sector), more = around ? int(kSectors) - 1 : min(int(sector + sectors) - first, int(kSectors) - 1);
    const int ring = window_of(int(rings.x), int(rings.y) - int(rings.x), int(kRings)), column = window_of(first & int(kSectors) - 1, more, int(kSectors));
    const int value = ring * int(3u * kSectors) + column;
    const vec4 four = texel_at(tables, int(start_table.w) - int(kWindowTexels) + (value >> 2));
    const float even = (value & 2) == 0 ? four.x : four.z, odd = (value & 2) == 0 ? four.y : four.w;
    return (value & 1) == 0 ? even : odd;
}

// Largest intensity towards the sphere, cd, of the lamp that begins with texel `at`, which is `a`.
float largest_intensity(int at, vec4 a, bool cone, bool measured, vec3 centre, float radius) {
    const vec4 b = texel_at(lamps, at + (measured ? 3 : 1)), c = texel_at(lamps, at + (measured ? 4 : 2));
    const vec2 cosines = cosines_to(a.xyz, measured ? c.xyz : b.xyz, centre, radius);
    float relative = largest_cone(b.w, c.w, cosines.x);
    if (kPowers != 0u) relative = cone ? relative : largest_power(b.w, cosines.x);
    if (kTables != 0u) relative = measured ? largest_table(centre - a.xyz, cosines, b, c, radius) : relative;
    return a.w * relative;
}

// Whether an intensity still gives the threshold at a distance, m.
bool gives_threshold(float intensity, float nearest, float threshold) {
    return nearest <= 0.0 ? intensity > 0.0 : kSlack * intensity >= threshold * nearest * nearest;
}
