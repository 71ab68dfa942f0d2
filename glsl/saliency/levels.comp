#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Means of luminance and of colour opponency, one level: weighted by finite pixels, so that borders and pixels that are not
// finite leave them exact. Opponency is that of the mean colour of the finest level, which is made of the scene itself (Walther and
// Koch 2006: differences over the largest channel, which do not depend on luminance); it fades where cones see nothing.

#include "shared/photometry.h"
#include "shared/saliency.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kFromScene = 0u;

layout(binding = 0, rgba32f) readonly uniform image2D from;
layout(binding = 1, rgba32f) writeonly uniform image2D to;
layout(push_constant, scalar) uniform Push { SaliencyLevelPush push; };

const uint kSide = kFromScene != 0u ? 1u << kSaliencyFinest : 2u;

vec2 opponency(vec3 rgb) {
    return vec2(rgb.r - rgb.g, rgb.b - min(rgb.r, rgb.g)) / (max(rgb.r, max(rgb.g, rgb.b)) + kScotopicBelow);
}

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.to_size))) return;
    vec3 sum = vec3(0.0);  // of RGB, or of luminance and opponency
    float pixels = 0.0;
    [[unroll]] for (uint y = 0u; y < kSide; ++y)
        [[unroll]] for (uint x = 0u; x < kSide; ++x) {
            const uvec2 child = kSide * at + uvec2(x, y);
            const vec4 texel = imageLoad(from, ivec2(min(child, push.from_size - 1u)));
            const bool inside = all(lessThan(child, push.from_size));
            if (kFromScene != 0u) {
                const bool counts = inside && abs(dot(texel.rgb, vec3(kRed, kGreen, kBlue))) <= 3.4e38;  // false for NaN and infinities
                pixels += counts ? 1.0 : 0.0;
                sum += counts ? clamp(texel.rgb, 0.0, kSaliencyBrightest) : vec3(0.0);
            } else {
                const float weight = inside ? texel.a : 0.0;
                pixels += weight;
                sum += weight * texel.rgb;
            }
        }
    const vec3 mean = sum / max(pixels, 1.0);
    imageStore(to, ivec2(at), vec4(kFromScene != 0u ? vec3(dot(mean, vec3(kRed, kGreen, kBlue)), opponency(mean)) : mean, pixels));
}
