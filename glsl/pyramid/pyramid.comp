#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

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

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.to_size))) return;
    float pixels = 0.0, sum = 0.0, log_sum = 0.0, largest = -3.4e38;
    // The logarithm of a product is one of its significands' and the sum of its exponents: one for four pixels.
    float significand = 1.0;
    int exponent = 0;
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        const uvec2 corner = uvec2(i & 1u, i >> 1u);
        const uvec2 child = push.apart == 0u ? 2u * at + corner : at - push.apart * corner;  // before the first: far beyond the last
        const vec4 texel = imageLoad(from, ivec2(min(child, push.from_size - 1u)));
        const bool inside = all(lessThan(child, push.from_size));
        if (kFromScene == 0u) {
            const float weight = inside ? texel.g : 0.0;
            pixels += weight;
            sum += weight > 0.0 ? weight * texel.r : 0.0;
            log_sum += weight > 0.0 ? weight * texel.b : 0.0;
            largest = weight > 0.0 ? max(largest, texel.a) : largest;
        } else {
            const float luminance = dot(texel.rgb, vec3(kRed, kGreen, kBlue));
            const bool counts = inside && abs(luminance) <= 3.4e38;  // false for NaN and infinities
            const int bits = floatBitsToInt(counts ? max(luminance, push.log_floor) + push.log_epsilon : 1.0);
            exponent += (bits >> 23) - 127;
            significand *= intBitsToFloat((bits & 0x7fffff) | 0x3f800000);
            pixels += counts ? 1.0 : 0.0;
            sum += counts ? luminance : 0.0;
            largest = counts ? max(largest, luminance) : largest;
        }
    }
    if (kFromScene != 0u) log_sum = float(exponent) * 0.6931471806 + log(significand);
    const float share = pixels > 0.0 ? 1.0 / pixels : 0.0;
    imageStore(to, ivec2(at), vec4(sum * share, pixels, log_sum * share, pixels > 0.0 ? largest : 0.0));
}
