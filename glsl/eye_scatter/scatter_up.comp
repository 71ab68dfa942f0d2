#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Light scattered in the eye, on the way up: means of a level under the weights of the quartic B-spline. Pixels that are not
// finite scatter nothing. Beyond the picture there is no light but that of the lamps given, and what other pictures have. An invocation goes down a strip; every
// two rows read are added to the three that they have a part in, so that they are read once.

#include "texels.glsl"
#include "shared/eye_scatter.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kColumns = 1u;    // texels of a strip
layout(constant_id = 1) const uint kRows = 1u;
layout(constant_id = 2) const uint kFromScene = 0u;  // 1: reads the picture, which has no margin

layout(binding = 0, rgba32f) readonly uniform image2D from;
TEXELS(1, vec4, lamps);
TEXELS(2, vec4, beyond);  // push.beyond
layout(binding = 3, rgba32f) writeonly uniform image2D means;
layout(push_constant, scalar) uniform Push { ScatterUpPush push; };

const uint kWide = 2u * kColumns + 4u;

vec3 light_at(ivec2 at) {
    const ivec2 last = ivec2(push.from_size) - 1;
    const ivec2 near = clamp(at, ivec2(0), last);  // at the edge of a level with margin nothing is left
    const vec3 light = imageLoad(from, near).rgb;
    if (kFromScene == 0u) return light;
    return near == at && abs(light.r + light.g + light.b) <= 3.4e38 ? light : vec3(0.0);
}

// The quartic B-spline, texels from its middle.
float spline(float x) {
    const float a = max(2.5 - abs(x), 0.0), b = max(1.5 - abs(x), 0.0), c = max(0.5 - abs(x), 0.0);
    return (a * a * a * a - 5.0 * b * b * b * b + 10.0 * c * c * c * c) / 24.0;
}

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy * uvec2(kColumns, kRows));
    const int margin = int(kScatterUpMargin);
    const ivec2 first = 2 * (at - margin) - 2 + (kFromScene != 0u ? 0 : margin);
    vec3 one_read[kColumns], two_read[kColumns];  // texels of which two rows of six are in, and four
    [[unroll]] for (uint i = 0u; i < kColumns; ++i) one_read[i] = two_read[i] = vec3(0.0);
    // Unrolled, this is many times as long to compile, and slower on a CPU.
    [[dont_unroll]] for (int y = -2; y < int(kRows); ++y) {
        vec3 across[2u * kColumns];
        [[unroll]] for (uint row = 0u; row < 2u; ++row) {
            vec3 light[kWide];
            [[unroll]] for (uint i = 0u; i < kWide; ++i) light[i] = light_at(first + ivec2(int(i), 2 * (y + 2) + int(row)));
            [[unroll]] for (uint i = 0u; i < kColumns; ++i)
                across[row * kColumns + i] = (10.0 * (light[2u * i + 2u] + light[2u * i + 3u]) + 5.0 * (light[2u * i + 1u] + light[2u * i + 4u]) +
                                              (light[2u * i] + light[2u * i + 5u])) / 1024.0;
        }
        vec3 mean[kColumns];
        [[unroll]] for (uint i = 0u; i < kColumns; ++i) {
            const vec3 upper = across[i], lower = across[kColumns + i];
            mean[i] = two_read[i] + 5.0 * upper + lower;
            two_read[i] = one_read[i] + 10.0 * (upper + lower);
            one_read[i] = upper + 5.0 * lower;
        }
        for (uint lamp = 0u; lamp < push.lamps; ++lamp) {
            const vec2 away = vec2(at + ivec2(0, y) - margin) + 0.5 - texel_at(lamps, int(2u * lamp)).xy;
            const vec3 light = spline(away.y) * texel_at(lamps, int(2u * lamp + 1u)).rgb;
            [[unroll]] for (uint i = 0u; i < kColumns; ++i) mean[i] += spline(away.x + float(i)) * light;
        }
        [[unroll]] for (uint i = 0u; i < kColumns; ++i) {
            const ivec2 texel = at + ivec2(int(i), y);
            if (y < 0 || any(greaterThanEqual(texel, ivec2(push.to_size)))) continue;
            if (kFromScene == 0u && push.beyond != 0u) mean[i] += texel_at(beyond, texel.y * int(push.to_size.x) + texel.x).rgb;
            imageStore(means, texel, vec4(mean[i], 1.0));
        }
    }
}
