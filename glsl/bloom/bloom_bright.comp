#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Bloom, first step: what of the displayed light reaches the threshold, averaged over blocks of pixels.

#include "shared/bloom.h"
#include "tone.glsl"

layout(local_size_x = 64) in;

layout(binding = 0, rgba32f) readonly uniform image2D scene_image;
layout(binding = 1) uniform samplerBuffer curve;
layout(binding = 2, rgba16f) writeonly uniform image2D bright_image;
layout(push_constant, scalar) uniform Push { BloomBrightPush push; };

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.small_size))) return;
    const Tone tone = read_tone(curve);
    vec3 sum = vec3(0.0);
    float pixels = 0.0;
    for (uint i = 0u; i < kBloomShrink * kBloomShrink; ++i) {
        const uvec2 pixel = kBloomShrink * at + uvec2(i % kBloomShrink, i / kBloomShrink);
        if (any(greaterThanEqual(pixel, push.size))) continue;
        const vec3 rgb = perceived(tone, imageLoad(scene_image, ivec2(pixel)).rgb);
        const vec3 light = displayed(curve, tone, rgb, rgb, rec709_gamut(), push.display_low, push.display_high);
        sum += max(light.r, max(light.g, light.b)) >= push.threshold ? light : vec3(0.0);
        pixels += 1.0;
    }
    imageStore(bright_image, ivec2(at), vec4(sum / pixels, 1.0));
}
