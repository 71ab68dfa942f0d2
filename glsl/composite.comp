#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Composite: scene luminance (and light scattered in the eye) through the tone curve, LDR glare, display codes.

#include "tone.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 1) const uint kLuminanceGlare = 0u;
layout(constant_id = 2) const uint kLdrGlare = 0u;
layout(constant_id = 3) const uint kRows = 1u;  // pixels of a column that one invocation does

layout(binding = 0, rgba32f) readonly uniform image2D scene_image;
layout(binding = 1) uniform samplerBuffer curve;
layout(binding = 2, rgba32f) readonly uniform image2D luminance_glare;  // cd/m^2; the scene itself where there is none
layout(binding = 3) uniform sampler2D ldr_glare;                        // displayed light; likewise
layout(binding = 4, rgba8) writeonly uniform image2D display_image;
layout(push_constant, scalar) uniform Push { CompositePush push; };

void main() {
    const Tone tone = read_tone(curve);
    [[unroll]] for (uint row = 0u; row < kRows; ++row) {
        const uvec2 at = gl_GlobalInvocationID.xy * uvec2(1u, kRows) + uvec2(0u, row);
        vec3 rgb = imageLoad(scene_image, ivec2(at)).rgb;
        if (kLuminanceGlare != 0u) rgb += imageLoad(luminance_glare, ivec2(at)).rgb;
        vec3 light = displayed(curve, tone, rgb, push.display_low, push.display_high);
        if (kLdrGlare != 0u) {
            // The glare texture covers whole blocks: its last row and column may reach beyond the image.
            const vec2 blocks = vec2(textureSize(ldr_glare, 0));
            light += push.ldr_glare * textureLod(ldr_glare, (vec2(at) + 0.5) / (float(kGlareShrink) * blocks), 0.0).rgb;
            light = min(light, vec3(1.0));
        }
        const vec4 code = vec4(pow(light, vec3(push.inverse_gamma)), 1.0);
        if (all(lessThan(at, push.size))) imageStore(display_image, ivec2(at), code);
    }
}
