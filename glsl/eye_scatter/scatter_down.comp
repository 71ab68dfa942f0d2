#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Light scattered in the eye, on the way down: what the level above gives, by the quartic B-spline, and this level filtered with
// a kernel of 5 x 5 or 7 x 7 that depends on the place, since pixels at the edge of a picture cover other angles. An invocation goes down a
// strip, two rows at a time; every row read is added to all that it has a part in, so that it is read once.

#include "texels.glsl"
#include "shared/eye_scatter.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kColumns = 1u;  // texels of a strip: 1, or even
layout(constant_id = 1) const uint kLast = 0u;     // 1: makes the picture, from pixels without margin
layout(constant_id = 2) const int kReach = 2;      // texels, of the kernel in each direction

layout(binding = 0, rgba32f) readonly uniform image2D level;
layout(binding = 1, rgba32f) readonly uniform image2D above;
TEXELS(2, vec4, taps);
layout(binding = 3, rgba32f) writeonly uniform image2D seen;
layout(push_constant, scalar) uniform Push { ScatterDownPush push; };

const int kColumn = int(kColumns), kWide = kColumn + 2 * kReach, kTapTexels = (2 * kReach * (kReach + 1) + 4) / 4;
const int kLag = (kReach + 1) / 2 * 2;  // rows, even, after which a row is complete
const uint kWideAbove = (kColumns + 1u) / 2u + 2u;

ivec2 inside(ivec2 at) { return clamp(at, ivec2(0), ivec2(push.size) - 1); }

// Of the picture or level without margin.
vec3 light_at(ivec2 at) { return imageLoad(level, kLast != 0u ? inside(at) : at + int(kScatterUpMargin)).rgb; }

// What is not finite scatters nothing, and beyond the picture is nothing.
vec3 scattered(vec3 light, ivec2 at) {
    if (kLast == 0u) return light;
    return inside(at) == at && abs(light.r + light.g + light.b) <= 3.4e38 ? light : vec3(0.0);
}

// Taps of a kernel, by four.
struct Taps { vec4 fours[7]; };

// Of a place between the four nodes about it.
Taps taps_at(vec2 at) {
    const vec2 place = clamp(push.scale * at, vec2(0.0), vec2(push.nodes - 1u));
    const vec2 first = min(floor(place), vec2(push.nodes - 2u)), part = place - first;
    const int node_texels = kTapTexels * int(push.levels);
    const int node = int(uint(first.y) * push.nodes.x + uint(first.x)), row = node_texels * int(push.nodes.x);
    const int base = node * node_texels + kTapTexels * int(push.level), next = base + node_texels;
    Taps all;
    [[unroll]] for (int i = 0; i < kTapTexels; ++i)
        all.fours[i] = mix(mix(texel_at(taps, base + i), texel_at(taps, next + i), part.x), mix(texel_at(taps, base + row + i), texel_at(taps, next + row + i), part.x), part.y);
    return all;
}

// The tap at an offset, in the order of scatter_taps.
float tap(Taps all, int x, int y) {
    const bool opposite = y < 0 || (y == 0 && x < 0);
    const int dx = opposite ? -x : x, dy = opposite ? -y : y;
    const int i = dy == 0 ? dx : kReach + 1 + (dy - 1) * (2 * kReach + 1) + dx + kReach;
    return all.fours[i / 4][i % 4];
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
    const Taps taps_above = taps_at(upper), taps_below = taps_at(upper + vec2(0.0, push.rows));

    vec3 begun[2 * kLag * kColumn];  // what is known of rows y - kLag .. y + kLag - 1
    vec3 coarse[2u * kColumns];      // the last two rows of the level above, across
    [[unroll]] for (int i = 0; i < 2 * kLag * kColumn; ++i) begun[i] = vec3(0.0);
    [[unroll]] for (uint i = 0u; i < 2u * kColumns; ++i) coarse[i] = vec3(0.0);
    // Unrolled, this is many times as long to compile, and slower on a CPU.
    [[dont_unroll]] for (int y = -kLag; y < int(push.rows) + kLag; y += 2) {
        Taps t;
        [[unroll]] for (int i = 0; i < kTapTexels; ++i) t.fours[i] = taps_above.fours[i] + float(y + 1) / float(push.rows) * (taps_below.fours[i] - taps_above.fours[i]);
        vec3 sum[(2 * kLag + 2) * kColumn];  // rows y - kLag .. y + kLag + 1
        [[unroll]] for (int i = 0; i < (2 * kLag + 2) * kColumn; ++i) sum[i] = i < 2 * kLag * kColumn ? begun[i] : vec3(0.0);
        [[unroll]] for (int row = 0; row < 2; ++row) {
            vec3 light[kWide];  // from kReach texels to the left to as many to the right
            const int own_row = (row + kLag) * kColumn;
            [[unroll]] for (int i = 0; i < kWide; ++i) {
                const ivec2 texel = at + ivec2(i - kReach, y + row);
                const vec3 own = light_at(texel);
                if (i >= kReach && i < kColumn + kReach) sum[own_row + i - kReach] += tap(t, 0, 0) * own;
                light[i] = scattered(own, texel);
            }
            [[unroll]] for (int column = 0; column < kColumn; ++column) {
                const int i = own_row + column, middle = column + kReach;
                [[unroll]] for (int dx = 1; dx <= kReach; ++dx) sum[i] += tap(t, dx, 0) * (light[middle - dx] + light[middle + dx]);
                // What lies dy rows further down, and as many further up.
                [[unroll]] for (int dy = 1; dy <= kReach; ++dy)
                    [[unroll]] for (int dx = -kReach; dx <= kReach; ++dx) {
                        sum[i - dy * kColumn] += tap(t, dx, dy) * light[middle + dx];
                        sum[i + dy * kColumn] += tap(t, dx, dy) * light[middle - dx];
                    }
            }
        }
        vec3 row_above[kWideAbove];
        [[unroll]] for (uint i = 0u; i < kWideAbove; ++i) row_above[i] = imageLoad(above, from + ivec2(i, max((y - kLag) / 2 + 2, 0))).rgb;
        [[unroll]] for (uint column = 0u; column < kColumns; ++column) {
            const vec3 first = coarse[column], second = coarse[kColumns + column], third = across(row_above, at.x + int(column), column);
            sum[column] += (5.0 * first + 10.0 * second + third) / 16.0;
            sum[kColumns + column] += (first + 10.0 * second + 5.0 * third) / 16.0;
            coarse[column] = second;
            coarse[kColumns + column] = third;
        }
        [[unroll]] for (uint i = 0u; i < 2u * kColumns; ++i) {
            const ivec2 texel = stored + ivec2(int(i % kColumns), y - kLag + int(i / kColumns));
            if (y >= kLag && all(lessThan(texel, ivec2(push.size)))) imageStore(seen, texel, vec4(sum[i], 1.0));
        }
        [[unroll]] for (int i = 0; i < 2 * kLag * kColumn; ++i) begun[i] = sum[i + 2 * kColumn];
    }
}
