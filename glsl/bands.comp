#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// One band of contrast, in the way of Grave and Bremond 2008 (reconstructed): contrast to the level above, a log average La, is
// shown with the same visibility level, the multiple of the contrast C = T(L) / L that an eye adapted to La just sees:
// ln L' = ln L'above + (ln L - ln La) C(curve(La)) / C(La). The topmost band stands on the tone curve itself. The finest gives pixels.

#include "shared/bands.h"
#include "threshold.glsl"
#include "tone.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 1) const uint kTopmost = 0u;
layout(constant_id = 2) const uint kFinest = 0u;

layout(binding = 0, rgba32f) readonly uniform image2D finer;         // the scene, cd/m^2 RGB, or a level of the pyramid
layout(binding = 1, rgba32f) readonly uniform image2D coarser;       // the level above: finite pixels, mean ln luminance
layout(binding = 2, rgba32f) readonly uniform image2D coarser_shown; // r: ln of what of it is shown; the level itself at the topmost
layout(binding = 3) uniform samplerBuffer curve;
layout(binding = 4, rgba32f) writeonly uniform image2D shown_image;  // r: ln of display luminance, cd/m^2; of the finest RGB, cd/m^2
layout(push_constant, scalar) uniform Push { BandsPush push; };

const float kLnBrightest = 13.8155106;  // 1e6 cd/m^2 on the display: no display shows more

// ln of the contrast that is just seen.
float ln_contrast(float ln_luminance) { return cone_log_threshold(ln_luminance / kLn10, push.cone_break) * kLn10 - ln_luminance; }

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.size))) return;

    // The level above at this place: bilinear over the texels that have finite pixels.
    const vec2 last = vec2(push.coarse_size) - 1.0;
    const vec2 position = clamp((vec2(at) + 0.5) * 0.5 - 0.5, vec2(0.0), last), base = floor(position), part = position - base;
    vec2 sum = vec2(0.0);
    float weights = 0.0;
    for (uint i = 0u; i < 4u; ++i) {
        const ivec2 texel = ivec2(min(base + vec2(i & 1u, i >> 1u), last));
        const vec4 level = imageLoad(coarser, texel);
        const float weight = level.g > 0.0 ? ((i & 1u) != 0u ? part.x : 1.0 - part.x) * (i > 1u ? part.y : 1.0 - part.y) : 0.0;
        sum += weight * vec2(level.b, kTopmost != 0u ? 0.0 : imageLoad(coarser_shown, texel).r);
        weights += weight;
    }
    const vec2 above = weights > 0.0 ? sum / weights : vec2(0.0);

    const Tone tone = read_tone(curve);
    const float adaptation_shown = node_at(curve, tone, exp(above.r)).r;
    const float steepness = exp(ln_contrast(adaptation_shown) - ln_contrast(above.r));
    const vec4 here = imageLoad(finer, ivec2(at));
    const float luminance = luminance_of(here.rgb);
    const float ln_luminance = kFinest != 0u ? log(max(luminance, kLuminanceFloor)) : here.b;
    const float ln_shown = min((kTopmost != 0u ? adaptation_shown : above.g) + (ln_luminance - above.r) * steepness, kLnBrightest);
    if (kFinest == 0u) {
        imageStore(shown_image, ivec2(at), vec4(ln_shown, 0.0, 0.0, 0.0));
        return;
    }
    // What is not finite stays so, and what has no light is grey.
    const float shown = exp(ln_shown);
    const vec3 rgb = luminance > 0.0 ? perceived(tone, here.rgb) * (shown / luminance) : vec3(shown);
    imageStore(shown_image, ivec2(at), vec4(is_finite(luminance) ? rgb : here.rgb, 1.0));
}
