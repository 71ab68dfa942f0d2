#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Light scattered in the eye, on the way up: means of a level under the weights of the quartic B-spline. Pixels that are not
// finite scatter nothing. Beyond the picture there is no light but that of the lamps given.

#include "shared/scatter.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kColumns = 1u;    // texels that one invocation does
layout(constant_id = 1) const uint kRows = 1u;
layout(constant_id = 2) const uint kFromScene = 0u;  // 1: reads the picture, which has no margin

layout(binding = 0, rgba32f) readonly uniform image2D from;
layout(binding = 1) uniform samplerBuffer lamps;
layout(binding = 2, rgba32f) writeonly uniform image2D means;
layout(push_constant, scalar) uniform Push { ScatterUpPush push; };

const float kFilter[6] = float[](1.0 / 32.0, 5.0 / 32.0, 10.0 / 32.0, 10.0 / 32.0, 5.0 / 32.0, 1.0 / 32.0);

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
    vec3 sum[kRows * kColumns];
    [[unroll]] for (uint i = 0u; i < kRows * kColumns; ++i) sum[i] = vec3(0.0);
    [[unroll]] for (uint row = 0u; row < 2u * kRows + 4u; ++row) {
        vec3 light[2u * kColumns + 4u];
        [[unroll]] for (uint i = 0u; i < 2u * kColumns + 4u; ++i) light[i] = light_at(first + ivec2(i, row));
        [[unroll]] for (uint column = 0u; column < kColumns; ++column) {
            vec3 across = vec3(0.0);
            [[unroll]] for (uint k = 0u; k < 6u; ++k) across += kFilter[k] * light[2u * column + k];
            // The texels of this column that the row has a part in.
            [[unroll]] for (uint to = 0u; to < kRows; ++to)
                if (row >= 2u * to && row < 2u * to + 6u) sum[to * kColumns + column] += kFilter[row - 2u * to] * across;
        }
    }
    [[unroll]] for (uint row = 0u; row < kRows; ++row)
        [[unroll]] for (uint column = 0u; column < kColumns; ++column) {
            const ivec2 texel = at + ivec2(column, row);
            vec3 mean = sum[row * kColumns + column];
            for (uint i = 0u; i < push.lamps; ++i) {
                const vec2 away = vec2(texel - margin) + 0.5 - texelFetch(lamps, int(2u * i)).xy;
                mean += spline(away.x) * spline(away.y) * texelFetch(lamps, int(2u * i + 1u)).rgb;
            }
            if (all(lessThan(texel, ivec2(push.to_size)))) imageStore(means, texel, vec4(mean, 1.0));
        }
}
