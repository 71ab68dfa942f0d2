#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Mean colour of the finite pixels of each square of kColourTile px, and how many those are.

#include "shared/luminance.h"
#include "shared/photometry.h"

layout(local_size_x = 64) in;

layout(binding = 0, rgba32f) readonly uniform image2D scene_image;
layout(binding = 1, rgba32f) writeonly uniform image2D colours_image;
layout(push_constant, scalar) uniform Push { ColoursPush push; };

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.tiles))) return;
    vec4 sum = vec4(0.0);
    const uvec2 first = at * kColourTile, end = min(first + kColourTile, push.size);
    for (uint y = first.y; y < end.y; ++y) {
        vec4 row = vec4(0.0);  // row by row: sums of thousand floats lose less
        for (uint x = first.x; x < end.x; ++x) {
            const vec3 rgb = imageLoad(scene_image, ivec2(x, y)).rgb;
            if (abs(dot(rgb, vec3(kRed, kGreen, kBlue))) <= 3.4e38) row += vec4(rgb, 1.0);
        }
        sum += row;
    }
    imageStore(colours_image, ivec2(at), vec4(sum.rgb / max(sum.a, 1.0), sum.a));
}
