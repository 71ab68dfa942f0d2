#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Luminance pyramid, one level: exact statistics of the finite pixels under each texel. Means are weighted by the number
// of pixels, so odd sizes, borders and pixels that are not finite leave them exact. Level 1 reads the scene image itself. Texels
// that overlap are made the same way, of four that lie apart.

#include "shared/luminance.h"
#include "shared/photometry.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kFromScene = 0u;

layout(binding = 0, rgba32f) readonly uniform image2D from;
layout(binding = 1, rgba32f) writeonly uniform image2D to;
layout(push_constant, scalar) uniform Push { PyramidPush push; };

// Mean luminance, pixels, mean logarithm, maximum.
vec4 statistics(uvec2 at) {
    const vec4 texel = imageLoad(from, ivec2(at));
    if (kFromScene == 0u) return texel;
    const float luminance = dot(texel.rgb, vec3(kRed, kGreen, kBlue));
    const bool finite = abs(luminance) <= 3.4e38;  // false for NaN and infinities
    return finite ? vec4(luminance, 1.0, log(max(luminance, push.log_floor) + push.log_epsilon), luminance) : vec4(0.0);
}

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.to_size))) return;
    float pixels = 0.0, sum = 0.0, log_sum = 0.0, largest = 0.0;
    bool any_yet = false;
    for (uint i = 0u; i < 4u; ++i) {
        const uvec2 corner = uvec2(i & 1u, i >> 1u);
        const uvec2 child = push.apart == 0u ? 2u * at + corner : at - push.apart * corner;  // before the first: far beyond the last
        if (any(greaterThanEqual(child, push.from_size))) continue;
        const vec4 s = statistics(child);
        if (s.g == 0.0) continue;
        pixels += s.g;
        sum += s.g * s.r;
        log_sum += s.g * s.b;
        largest = any_yet ? max(largest, s.a) : s.a;
        any_yet = true;
    }
    const float share = pixels > 0.0 ? 1.0 / pixels : 0.0;
    imageStore(to, ivec2(at), vec4(sum * share, pixels, log_sum * share, largest));
}
