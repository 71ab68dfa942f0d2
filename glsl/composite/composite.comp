#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Composite: scene luminance through the tone curve, bloom, display codes.

#include "encode.glsl"
#include "show.glsl"

layout(constant_id = 4) const uint kBlueFirst = 0u;  // codes begin with blue

layout(binding = 3) uniform samplerBuffer cells;
layout(binding = 4, r32ui) writeonly uniform uimage2D display_image;

void main() {
    const Tone tone = read_tone(curve);
    const Gamut gamut = gamut_of_the_display();
    const uvec2 first = gl_GlobalInvocationID.xy * uvec2(1u, kRows);
    find_light(tone, gamut, first);
    [[unroll]] for (uint row = 0u; row < kRows; ++row) {
        const uvec2 at = first + uvec2(0u, row);
        const uint codes = codes_of(cells, push.encode, kBlueFirst == 0u ? light[row] : light[row].bgr);
        if (all(lessThan(at, push.size))) imageStore(display_image, ivec2(at), uvec4(codes));
    }
}
