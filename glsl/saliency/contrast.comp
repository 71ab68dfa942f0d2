#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Contrast of a level against its surround, which is linear between the middles of texels of a level above: means over the texels
// of the map. Luminance is compared relative to the surround; opponency and oriented contrast are relative already. Each opponent colour
// has a map of its own: one red place among green ones is alone in its map.

#include "shared/saliency.h"

layout(local_size_x = 64) in;

layout(binding = 0, rgba32f) readonly uniform image2D centre;
layout(binding = 1, rgba32f) readonly uniform image2D centre_oriented;
layout(binding = 2, rgba32f) readonly uniform image2D surround;
layout(binding = 3, rgba32f) readonly uniform image2D surround_oriented;
layout(binding = 4, rgba32f) writeonly uniform image2D maps;
layout(push_constant, scalar) uniform Push { ContrastPush push; };

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.map_size))) return;
    float intensity = 0.0, texels = 0.0;
    vec4 colours = vec4(0.0), oriented = vec4(0.0);
    [[dont_unroll]] for (uint i = 0u; i < push.block * push.block; ++i) {
        const uvec2 here = push.block * at + uvec2(i % push.block, i / push.block);
        const ivec2 texel = ivec2(min(here, push.centre_size - 1u));
        const vec4 own = imageLoad(centre, texel), own_oriented = imageLoad(centre_oriented, texel);
        const vec2 place = clamp((vec2(texel) + 0.5) * push.ratio - 0.5, vec2(0.0), vec2(push.surround_size - 1u));
        const vec2 first = floor(place), part = place - first;
        vec3 about = vec3(0.0);
        vec4 about_oriented = vec4(0.0);
        float weights = 0.0;
        [[unroll]] for (int k = 0; k < 4; ++k) {
            const ivec2 corner = ivec2(k & 1, k >> 1), from = min(ivec2(first) + corner, ivec2(push.surround_size) - 1);
            const vec4 value = imageLoad(surround, from);
            const vec2 share = mix(1.0 - part, part, vec2(corner));
            const float weight = value.a > 0.0 ? share.x * share.y : 0.0;
            about += weight * value.rgb;
            about_oriented += weight * imageLoad(surround_oriented, from);
            weights += weight;
        }
        if (any(greaterThanEqual(here, push.centre_size)) || !(own.a > 0.0) || !(weights > 0.0)) continue;
        about /= weights, about_oriented /= weights;
        const vec2 opponent = own.gb - about.gb;
        intensity += abs(own.r - about.r) / (about.r + kDarkLight);
        colours += max(vec4(opponent, -opponent), 0.0);
        oriented += abs(own_oriented - about_oriented);
        texels += 1.0;
    }
    const float share = 1.0 / max(texels, 1.0);
    const ivec2 to = ivec2(at.x + push.pair * push.map_size.x, at.y);
    const int kind = int(push.map_size.y);
    imageStore(maps, to, vec4(share * intensity, 0.0, 0.0, 0.0));
    imageStore(maps, ivec2(to.x, to.y + kind), share * colours);
    imageStore(maps, ivec2(to.x, to.y + 2 * kind), share * oriented);
}
