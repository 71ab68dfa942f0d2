#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Light scattered in the eye, on the way down: what the level above gives, by the quartic B-spline, and this level filtered with
// a small kernel that depends on the place, since pixels at the edge of a picture cover other angles.

#include "shared/scatter.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kColumns = 1u;  // texels that one invocation does: 1, or even
layout(constant_id = 1) const uint kRows = 1u;
layout(constant_id = 2) const uint kFine = 0u;     // 1: makes the picture, with 5 x 5 taps, from pixels without margin

layout(binding = 0, rgba32f) readonly uniform image2D level;
layout(binding = 1, rgba32f) readonly uniform image2D above;
layout(binding = 2) uniform samplerBuffer taps;
layout(binding = 3, rgba32f) writeonly uniform image2D seen;
layout(push_constant, scalar) uniform Push { ScatterDownPush push; };

const int kReach = int(kFine) + 1;  // of the kernel, texels
const uint kCoarseRows = (kRows + 1u) / 2u + 2u, kCoarseColumns = (kColumns + 1u) / 2u + 2u;

// Without the margin. What is not finite scatters nothing.
vec3 light_at(ivec2 at) {
    if (kFine == 0u) return imageLoad(level, at + int(kScatterUpMargin)).rgb;
    const ivec2 near = clamp(at, ivec2(0), ivec2(push.size) - 1);
    const vec3 light = imageLoad(level, near).rgb;
    return near == at && abs(light.r + light.g + light.b) <= 3.4e38 ? light : vec3(0.0);
}

// Between the four nodes about a texel.
vec4 taps_at(vec2 at, uint texel) {
    const vec2 place = clamp(push.scale * at, vec2(0.0), vec2(push.nodes - 1u));
    const vec2 first = min(floor(place), vec2(push.nodes - 2u)), part = place - first;
    const int node = int(uint(first.y) * push.nodes.x + uint(first.x)), row = int(push.node_texels * push.nodes.x);
    const int base = node * int(push.node_texels) + int(push.first_texel + texel), next = base + int(push.node_texels);
    return mix(mix(texelFetch(taps, base), texelFetch(taps, next), part.x), mix(texelFetch(taps, base + row), texelFetch(taps, next + row), part.x), part.y);
}

// Weights of three neighbours of the level above.
vec3 spline(int at) { return (at & 1) == 0 ? vec3(5.0, 10.0, 1.0) / 16.0 : vec3(1.0, 10.0, 5.0) / 16.0; }

void main() {
    const int margin = kFine != 0u ? 0 : int(kScatterDownMargin);
    const ivec2 stored = ivec2(gl_GlobalInvocationID.xy * uvec2(kColumns, kRows)), at = stored - margin;
    vec3 sum[kRows * kColumns];

    const ivec2 from = (at >> 1) - 1 + int(kScatterDownMargin);
    vec3 coarse[kCoarseRows * kColumns];
    [[unroll]] for (uint row = 0u; row < kCoarseRows; ++row) {
        vec3 light[kCoarseColumns];
        [[unroll]] for (uint i = 0u; i < kCoarseColumns; ++i) light[i] = imageLoad(above, from + ivec2(i, row)).rgb;
        [[unroll]] for (uint column = 0u; column < kColumns; ++column) {
            const vec3 w = spline(at.x + int(column));
            coarse[row * kColumns + column] = w.x * light[column / 2u] + w.y * light[column / 2u + 1u] + w.z * light[column / 2u + 2u];
        }
    }
    [[unroll]] for (uint row = 0u; row < kRows; ++row) {
        const vec3 w = spline(at.y + int(row));
        [[unroll]] for (uint column = 0u; column < kColumns; ++column) {
            const uint first = row / 2u * kColumns + column;
            sum[row * kColumns + column] = w.x * coarse[first] + w.y * coarse[first + kColumns] + w.z * coarse[first + 2u * kColumns];
        }
    }

    // In the order of kScatterTaps: (0, 0) (1, 0) (0, 1) (1, 1) | (1, -1) (2, 0) (0, 2) (2, 1) | (2, -1) (1, 2) (1, -2) (2, 2) | (2, -2).
    const vec2 middle = vec2(at) + 0.5 * vec2(kColumns, kRows);
    const vec4 a = taps_at(middle, 0u), b = taps_at(middle, 1u);
    vec4 c = vec4(0.0), d = vec4(0.0);
    if (kFine != 0u) c = taps_at(middle, 2u), d = taps_at(middle, 3u);
    [[unroll]] for (int row = -kReach; row < int(kRows) + kReach; ++row) {
        vec3 light[kColumns + 4u];  // from two texels to the left to two to the right
        [[unroll]] for (uint i = 2u - uint(kReach); i < kColumns + 2u + uint(kReach); ++i) light[i] = light_at(at + ivec2(int(i) - 2, row));
        [[unroll]] for (int column = 0; column < int(kColumns); ++column) {
            const int i = row * int(kColumns) + column, next = int(kColumns);
            const vec3 left = light[column + 1], own = light[column + 2], right = light[column + 3];
            if (row >= 0 && row < int(kRows)) sum[i] += a.x * own + a.y * (left + right);
            // This row lies below the one before it, and above the one after.
            if (row >= 1 && row <= int(kRows)) sum[i - next] += a.z * own + a.w * right + b.x * left;
            if (row >= -1 && row < int(kRows) - 1) sum[i + next] += a.z * own + a.w * left + b.x * right;
            if (kFine == 0u) continue;
            const vec3 left2 = light[column], right2 = light[column + 4];
            if (row >= 0 && row < int(kRows)) sum[i] += b.y * (left2 + right2);
            if (row >= 1 && row <= int(kRows)) sum[i - next] += b.w * right2 + c.x * left2;
            if (row >= -1 && row < int(kRows) - 1) sum[i + next] += b.w * left2 + c.x * right2;
            if (row >= 2) sum[i - 2 * next] += b.z * own + c.y * right + c.z * left + c.w * right2 + d.x * left2;
            if (row < int(kRows) - 2) sum[i + 2 * next] += b.z * own + c.y * left + c.z * right + c.w * left2 + d.x * right2;
        }
    }
    [[unroll]] for (uint row = 0u; row < kRows; ++row)
        [[unroll]] for (uint column = 0u; column < kColumns; ++column) {
            const ivec2 texel = stored + ivec2(column, row);
            vec3 light = sum[row * kColumns + column];
            if (kFine != 0u) {
                const vec3 own = imageLoad(level, min(texel, ivec2(push.size) - 1)).rgb;
                if (!(abs(own.r + own.g + own.b) <= 3.4e38)) light = own;  // stays as it is
            }
            if (all(lessThan(texel, ivec2(push.size)))) imageStore(seen, texel, vec4(light, 1.0));
        }
}
