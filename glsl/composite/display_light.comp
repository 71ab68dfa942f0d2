#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// What the display would emit and reflect if it had every colour and no peak, cd/m^2.

#include "show.glsl"

layout(binding = 3, rgba32f) writeonly uniform image2D light_image;

void main() {
    const Tone tone = read_tone(curve);
    [[unroll]] for (uint row = 0u; row < kRows; ++row) {
        const uvec2 at = gl_GlobalInvocationID.xy * uvec2(1u, kRows) + uvec2(0u, row);
        vec3 light = displayed_unbounded(curve, tone, perceived(tone, scene_light(at)), push.display_low, push.display_high);
        if (kBloom != 0u) light += bloom_light(at);
        light = push.display_low + (push.display_high - push.display_low) * light;
        if (all(lessThan(at, push.size))) imageStore(light_image, ivec2(at), vec4(light, 1.0));
    }
}
