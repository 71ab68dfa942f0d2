#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Light scattered in the eye, on the way down: what the level above gives, by the quartic B-spline, and this level filtered with
// a kernel of 5 x 5 that depends on the place, since pixels at the edge of a picture cover other angles. An invocation goes down a
// strip, two rows at a time; every row read is added to the five that it has a part in, so that it is read once.

#include "shared/scatter.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kColumns = 1u;  // texels of a strip: 1, or even
layout(constant_id = 1) const uint kLast = 0u;     // 1: makes the picture, from pixels without margin

layout(binding = 0, rgba32f) readonly uniform image2D level;
layout(binding = 1, rgba32f) readonly uniform image2D above;
layout(binding = 2) uniform samplerBuffer taps;
layout(binding = 3, rgba32f) writeonly uniform image2D seen;
layout(push_constant, scalar) uniform Push { ScatterDownPush push; };

const uint kWide = kColumns + 4u, kWideAbove = (kColumns + 1u) / 2u + 2u;

ivec2 inside(ivec2 at) { return clamp(at, ivec2(0), ivec2(push.size) - 1); }

// Of the picture or level without margin.
vec3 light_at(ivec2 at) { return imageLoad(level, kLast != 0u ? inside(at) : at + int(kScatterUpMargin)).rgb; }

// What is not finite scatters nothing, and beyond the picture is nothing.
vec3 scattered(vec3 light, ivec2 at) {
    if (kLast == 0u) return light;
    return inside(at) == at && abs(light.r + light.g + light.b) <= 3.4e38 ? light : vec3(0.0);
}

// Taps of a place between the four nodes about it, by four: in the order of kScatterTaps.
mat4 taps_at(vec2 at) {
    const vec2 place = clamp(push.scale * at, vec2(0.0), vec2(push.nodes - 1u));
    const vec2 first = min(floor(place), vec2(push.nodes - 2u)), part = place - first;
    const uint node_texels = kScatterTapTexels * push.levels;
    const int node = int(uint(first.y) * push.nodes.x + uint(first.x)), row = int(node_texels * push.nodes.x);
    const int base = node * int(node_texels) + int(kScatterTapTexels * push.level), next = base + int(node_texels);
    mat4 all;
    [[unroll]] for (int i = 0; i < int(kScatterTapTexels); ++i)
        all[i] = mix(mix(texelFetch(taps, base + i), texelFetch(taps, next + i), part.x), mix(texelFetch(taps, base + row + i), texelFetch(taps, next + row + i), part.x), part.y);
    return all;
}

// One column of a row of the level above, by the spline.
vec3 across(vec3 row[kWideAbove], int x, uint column) {
    const vec3 w = (x & 1) == 0 ? vec3(5.0, 10.0, 1.0) / 16.0 : vec3(1.0, 10.0, 5.0) / 16.0;
    return w.x * row[column / 2u] + w.y * row[column / 2u + 1u] + w.z * row[column / 2u + 2u];
}

void main() {
    const int margin = kLast != 0u ? 0 : int(kScatterDownMargin);
    const ivec2 stored = ivec2(gl_GlobalInvocationID.xy * uvec2(kColumns, push.rows)), at = stored - margin;
    const ivec2 from = (at >> 1) - 1 + int(kScatterDownMargin);
    const vec2 upper = vec2(at) + vec2(0.5 * float(kColumns), 0.0);
    const mat4 taps_above = taps_at(upper), taps_further = taps_at(upper + vec2(0.0, push.rows)) - taps_above;

    vec3 begun[4u * kColumns];   // what is known of rows y - 2 .. y + 1
    vec3 coarse[2u * kColumns];  // the last two rows of the level above, across
    [[unroll]] for (uint i = 0u; i < 4u * kColumns; ++i) begun[i] = vec3(0.0);
    [[unroll]] for (uint i = 0u; i < 2u * kColumns; ++i) coarse[i] = vec3(0.0);
    // Unrolled, this is many times as long to compile, and slower on a CPU.
    [[dont_unroll]] for (int y = -2; y < int(push.rows) + 2; y += 2) {
        const mat4 t = taps_above + float(y + 1) / float(push.rows) * taps_further;
        vec3 sum[6u * kColumns];  // rows y - 2 .. y + 3
        [[unroll]] for (uint i = 0u; i < 6u * kColumns; ++i) sum[i] = i < 4u * kColumns ? begun[i] : vec3(0.0);
        [[unroll]] for (uint row = 0u; row < 2u; ++row) {
            vec3 light[kWide];  // from two texels to the left to two to the right
            [[unroll]] for (uint i = 0u; i < kWide; ++i) {
                const ivec2 texel = at + ivec2(int(i) - 2, y + int(row));
                const vec3 own = light_at(texel);
                if (i >= 2u && i < kColumns + 2u) sum[(row + 2u) * kColumns + i - 2u] += t[0].x * own;
                light[i] = scattered(own, texel);
            }
            // (0, 0) (1, 0) (0, 1) (1, 1) | (1, -1) (2, 0) (0, 2) (2, 1) | (2, -1) (1, 2) (1, -2) (2, 2) | (2, -2), and their opposites.
            [[unroll]] for (uint column = 0u; column < kColumns; ++column) {
                const uint i = (row + 2u) * kColumns + column, next = kColumns;
                const vec3 left2 = light[column], left = light[column + 1u], own = light[column + 2u], right = light[column + 3u], right2 = light[column + 4u];
                sum[i] += t[0].y * (left + right) + t[1].y * (left2 + right2);
                sum[i - next] += t[0].z * own + t[0].w * right + t[1].x * left + t[1].w * right2 + t[2].x * left2;
                sum[i + next] += t[0].z * own + t[0].w * left + t[1].x * right + t[1].w * left2 + t[2].x * right2;
                sum[i - 2u * next] += t[1].z * own + t[2].y * right + t[2].z * left + t[2].w * right2 + t[3].x * left2;
                sum[i + 2u * next] += t[1].z * own + t[2].y * left + t[2].z * right + t[2].w * left2 + t[3].x * right2;
            }
        }
        vec3 row_above[kWideAbove];
        [[unroll]] for (uint i = 0u; i < kWideAbove; ++i) row_above[i] = imageLoad(above, from + ivec2(i, y / 2 + 1)).rgb;
        [[unroll]] for (uint column = 0u; column < kColumns; ++column) {
            const vec3 first = coarse[column], second = coarse[kColumns + column], third = across(row_above, at.x + int(column), column);
            sum[column] += (5.0 * first + 10.0 * second + third) / 16.0;
            sum[kColumns + column] += (first + 10.0 * second + 5.0 * third) / 16.0;
            coarse[column] = second;
            coarse[kColumns + column] = third;
        }
        [[unroll]] for (uint i = 0u; i < 2u * kColumns; ++i) {
            const ivec2 texel = stored + ivec2(int(i % kColumns), y - 2 + int(i / kColumns));
            if (y >= 2 && all(lessThan(texel, ivec2(push.size)))) imageStore(seen, texel, vec4(sum[i], 1.0));
        }
        [[unroll]] for (uint i = 0u; i < 4u * kColumns; ++i) begun[i] = sum[i + 2u * kColumns];
    }
}
