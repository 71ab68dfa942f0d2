#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Adds what needles and halo of the brightest lamps have beyond the veil that is there already, by the angle from each lamp and the azimuth about
// it. Where lamp or pixel are wider than a part of the pattern its means are taken.

#include "texels.glsl"
#include "shared/corona.h"
#include "shared/photometry.h"

layout(local_size_x = 16, local_size_y = 16) in;

layout(binding = 0, scalar) readonly buffer Lamps { CoronaLamp lamps[]; };
TEXELS(1, vec4, pattern);
layout(binding = 2, rgba32f) uniform image2D seen;
layout(push_constant, scalar) uniform Push { CoronaPush push; };

const float kStep = 2.0 * kPi / float(kPatternColumns), kDegrees = 180.0 / kPi;

shared uint reached;  // a bit for each lamp whose pattern has a part in the workgroup's pixels

vec3 ray_of(vec2 place) { return normalize(vec3(push.ray_scale * place + push.ray_offset, -1.0)); }

// A row of the pattern at one of its levels, linearly between the middles of columns, which go around. `turn`: 0 .. 1.
vec3 level_at(uint row, uint level, float turn) {
    const uint columns = kPatternColumns >> level, first = row * kPatternStride + 2u * (kPatternColumns - columns);
    const float x = turn * float(columns) + 0.5 * float(2 * int(columns) - 1), left = floor(x);
    const uint x0 = uint(left) & (columns - 1u), x1 = (x0 + 1u) & (columns - 1u);
    return mix(texel_at(pattern, int(first + x0)).rgb, texel_at(pattern, int(first + x1)).rgb, x - left);
}

vec3 added(CoronaLamp lamp, vec3 ray, float pixel) {
    const vec3 away = ray - lamp.direction;
    const float square = dot(away, away), angle = kDegrees * sqrt(square) * (1.0 + square / 24.0);  // of a chord
    const float row = log(max(angle, 1e-6) / float(kPatternReach)) / kStep + float(kPatternRows);
    if (!(row > 0.0 && row < float(kPatternRows))) return vec3(0.0);
    const vec3 right = normalize(vec3(1.0, 0.0, 0.0) - lamp.direction * lamp.direction.x), up = cross(right, lamp.direction);
    const float turn = atan(dot(away, up), dot(away, right)) / (2.0 * kPi);
    const float column = angle / kDegrees * kStep;  // rad, as wide as one is there
    const float level = clamp(0.5 * log2((pixel + lamp.blur) / (column * column)), 0.0, float(kPatternLevels - 1u));
    const float lower = min(floor(level), float(kPatternLevels - 2u));
    return mix(level_at(uint(row), uint(lower), turn), level_at(uint(row), uint(lower) + 1u, turn), level - lower) * lamp.light / (angle * angle);
}

void main() {
    if (gl_LocalInvocationIndex == 0u) reached = 0u;
    barrier();
    if (gl_LocalInvocationIndex < kCoronaLamps) {
        const vec2 low = vec2(gl_WorkGroupID.xy * gl_WorkGroupSize.xy), high = low + vec2(gl_WorkGroupSize.xy);
        const vec3 middle = ray_of(0.5 * (low + high));
        const float around = max(max(distance(middle, ray_of(low)), distance(middle, ray_of(high))),
                                 max(distance(middle, ray_of(vec2(low.x, high.y))), distance(middle, ray_of(vec2(high.x, low.y)))));
        const CoronaLamp lamp = lamps[gl_LocalInvocationIndex];
        const bool lit = lamp.light.r + lamp.light.g + lamp.light.b > 0.0;
        if (lit && distance(middle, lamp.direction) < around + float(kPatternReach) / kDegrees) atomicOr(reached, 1u << gl_LocalInvocationIndex);
    }
    barrier();
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    uint left = reached;
    if (left == 0u || any(greaterThanEqual(pixel, push.size))) return;
    const vec3 straight = vec3(push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset, -1.0);
    const float cosine = inversesqrt(dot(straight, straight)), steradians = abs(push.ray_scale.x * push.ray_scale.y) * cosine * cosine * cosine;
    vec3 sum = vec3(0.0);
    while (left != 0u) {
        const int i = findLSB(left);
        left &= left - 1u;
        sum += added(lamps[i], straight * cosine, steradians);
    }
    const vec4 veiled = imageLoad(seen, ivec2(pixel));
    if (abs(veiled.r + veiled.g + veiled.b) <= 3.4e38) imageStore(seen, ivec2(pixel), vec4(max(veiled.rgb + sum, min(veiled.rgb, vec3(0.0))), veiled.a));
}
