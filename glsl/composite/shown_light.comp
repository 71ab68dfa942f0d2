#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// What composite.comp gives codes to: displayed light in the display's primaries.

#include "show.glsl"

layout(binding = 3, rgba32f) writeonly uniform image2D light_image;

void main() {
    const Tone tone = read_tone(curve);
    const Gamut gamut = gamut_of_the_display();
    const uvec2 first = gl_GlobalInvocationID.xy * uvec2(1u, kRows);
    find_light(tone, gamut, first);
    [[unroll]] for (uint row = 0u; row < kRows; ++row) {
        const uvec2 at = first + uvec2(0u, row);
        if (all(lessThan(at, push.size))) imageStore(light_image, ivec2(at), vec4(light[row], 1.0));
    }
}
