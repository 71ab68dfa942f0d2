#include "shared/gbuffer.h"

// Octahedral map of a unit vector (Meyer et al. 2010): two numbers in [-1, 1], and back.

vec2 encode_normal(vec3 n) {
    const vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    const vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return n.z < 0.0 ? folded : p;
}

// Normals of a relief, which may face what its plane turns away from, are marked: their first number has this added.
const float kReliefMark = 4.0;

bool is_relief(vec2 p) { return p.x > 0.5 * kReliefMark; }

vec3 decode_normal(vec2 marked) {
    const vec2 p = vec2(is_relief(marked) ? marked.x - kReliefMark : marked.x, marked.y);
    const float z = 1.0 - abs(p.x) - abs(p.y);
    const vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return normalize(vec3(z < 0.0 ? folded : p, z));
}

// The normal of the plane of a triangle, towards the eye, by GBuffer::slope. `ray`: through the pixel, z is -1; `ray_scale`: how it
// changes with a step of a pixel. Where the interpolated normal is as near as rounding may be, or there is no slope, that one.
vec3 plane_normal(uint slope, vec3 ray, vec2 ray_scale, vec3 interpolated) {
    const vec2 tilt = unpackHalf2x16(slope) / (kSlopeScale * ray_scale);
    const vec3 n = normalize(vec3(-tilt, 1.0 - dot(tilt, ray.xy)));
    const float rounding = max(0.01, 4e-7 / min(abs(ray_scale.x), abs(ray_scale.y)));
    return distance(n, interpolated) > rounding ? n : interpolated;
}
