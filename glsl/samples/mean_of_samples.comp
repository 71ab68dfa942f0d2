#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// The mean of the samples of every pixel.

#include "shared/samples.h"

layout(local_size_x = 64) in;
layout(binding = 0, std430) readonly buffer Sums { vec4 sums[]; };
layout(binding = 1, std430) readonly buffer Rests { vec4 rests[]; };
layout(binding = 2, rgba32f) writeonly uniform image2D scene;
layout(push_constant, scalar) uniform Push { SamplesPush push; };

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.size))) return;
    const int pixel = int(at.y * push.size.x + at.x);
    imageStore(scene, ivec2(at), vec4((sums[pixel].rgb + rests[pixel].rgb) / push.samples, 1.0));
}
