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
    [[unroll]] for (uint row = 0u; row < kRows; ++row) {
        const uvec2 at = gl_GlobalInvocationID.xy * uvec2(1u, kRows) + uvec2(0u, row);
        const vec3 light = shown_light(tone, gamut, at);
        if (all(lessThan(at, push.size))) imageStore(light_image, ivec2(at), vec4(light, 1.0));
    }
}
