#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// One direction of a separable Gaussian. Outside the image there is no light.

#include "shared/bloom.h"

layout(local_size_x = 64) in;

layout(binding = 0, rgba16f) readonly uniform image2D from;
layout(binding = 1) uniform samplerBuffer weights;
layout(binding = 2, rgba16f) writeonly uniform image2D to;
layout(push_constant, scalar) uniform Push { BloomBlurPush push; };

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = ivec2(push.size);
    if (any(greaterThanEqual(at, size))) return;
    vec3 sum = vec3(0.0);
    for (int i = -int(push.radius); i <= int(push.radius); ++i) {
        const ivec2 tap = at + i * ivec2(push.step);
        if (any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, size))) continue;
        sum += texelFetch(weights, abs(i)).r * imageLoad(from, tap).rgb;
    }
    imageStore(to, at, vec4(sum, 1.0));
}
