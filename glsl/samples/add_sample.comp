#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Adds a sample of every pixel to the sum of those before. What rounding takes from the sum is kept beside it (Knuth's
// two-sum), so that thousands of samples lose no more than the last one does.

#include "shared/samples.h"

layout(local_size_x = 64) in;
layout(binding = 0, rgba32f) readonly uniform image2D scene;
layout(binding = 1, std430) buffer Sums { vec4 sums[]; };
layout(binding = 2, std430) buffer Rests { vec4 rests[]; };
layout(push_constant, scalar) uniform Push { SamplesPush push; };

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.size))) return;
    const int pixel = int(at.y * push.size.x + at.x);
    const vec3 added = imageLoad(scene, ivec2(at)).rgb;
    vec3 before = vec3(0.0), rest = vec3(0.0);
    if (push.first == 0u) before = sums[pixel].rgb, rest = rests[pixel].rgb;
    precise const vec3 sum = before + added, taken = sum - before;
    precise const vec3 lost = (before - (sum - taken)) + (added - taken);
    sums[pixel] = vec4(sum, 0.0);
    rests[pixel] = vec4(rest + lost, 0.0);
}
