#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Light under the tents of one level: those of the level below at the node, and half of each of its neighbours there.

#include "shared/light_sums.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool kFirst = false;  // the level below is the picture

layout(binding = 0, rgba32f) readonly uniform image2D picture;
layout(binding = 1, scalar) buffer Sums { vec4 sums[]; };  // RGB, lx, of all levels from 1 on
layout(push_constant, scalar) uniform Push { LightSumsPush push; };

#include "light_sums.glsl"

vec3 below(ivec2 node) {
    if (kFirst) return light_of_pixel(node, push.scale, push.offset, push.pixel_area);
    return sums[push.first_from + uint(node.y) * push.from.x + uint(node.x)].rgb;
}

void main() {
    const uvec2 node = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(node, push.to))) return;
    vec3 sum = vec3(0.0);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            const ivec2 at = 2 * ivec2(node) + ivec2(x, y);
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(push.from)))) continue;
            sum += (x == 0 ? 1.0 : 0.5) * (y == 0 ? 1.0 : 0.5) * below(at);
        }
    sums[push.first_to + node.y * push.to.x + node.x] = vec4(sum, 0.0);
}
