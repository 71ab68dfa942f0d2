#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// One band of contrast, in the way of Grave and Bremond 2008 (reconstructed): contrast to a texel of the level above, a log
// average La shown at L'a, has the same visibility level there, the multiple of the contrast C = T(L) / L that is just seen: of an eye
// adapted to La in the scene, to 0.3 of white on the display; but no more contrast than in the scene. ln L' = ln L'a + s (ln L - ln La),
// s = min(C_display(curve(La)) / C(La), 1). So a texel hands three numbers down, ln s, ln La and ln L'a, which are linear between texels:
// mixing s itself would let the darker side of an edge rule, and the brighter one glow. The topmost are shown as the tone curve has them.
// The finest band gives pixels.

#include "shared/bands.h"
#include "threshold.glsl"
#include "tone.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 1) const uint kBand = kBandMiddle;

layout(binding = 0, rgba32f) readonly uniform image2D here_image;   // a level of the pyramid, or the scene, cd/m^2 RGB
layout(binding = 1, rgba32f) readonly uniform image2D above_image;  // the level above: ln s, ln La, ln L'a, 1 (0 without finite pixels)
layout(binding = 2) uniform samplerBuffer curve;
layout(binding = 3, rgba32f) writeonly uniform image2D shown_image;  // the same of this level; of the finest RGB, cd/m^2
layout(push_constant, scalar) uniform Push { BandsPush push; };

const float kLnBrightest = 13.8155106;  // 1e6 cd/m^2 on the display: no display shows more

// ln of the contrast that is just seen: in the scene, and on the display.
float ln_contrast(float ln_luminance) { return cone_log_threshold(ln_luminance / kLn10, push.cone_break) * kLn10 - ln_luminance; }
float ln_contrast_shown(float ln_luminance) {
    const float luminance = exp(ln_luminance), reach = luminance + push.viewer_sigma;
    return log(push.viewer_step * (reach / push.viewer_sigma) * (reach / luminance));
}

// What a texel hands down: of log average luminance `ln_luminance`, shown at `ln_shown`.
vec4 handed_down(float ln_luminance, float ln_shown, float ln_curve) {
    return vec4(min(ln_contrast_shown(ln_curve) - ln_contrast(ln_luminance), 0.0), ln_luminance, ln_shown, 1.0);
}

// ln of display luminance of what is seen under texels that hand down `above`.
float seen_under(vec3 above, float ln_luminance) { return min(above.z + exp(above.x) * (ln_luminance - above.y), kLnBrightest); }

// One pixel. What is not finite stays so, and what has no light is grey.
vec3 shown_pixel(Tone tone, vec3 rgb, vec3 above) {
    const float luminance = luminance_of(rgb);
    const float shown = exp(seen_under(above, log(max(luminance, kLuminanceFloor))));
    if (!is_finite(luminance)) return rgb;
    return luminance > 0.0 ? perceived(tone, rgb) * (shown / luminance) : vec3(shown);
}

void main() {
    const Tone tone = read_tone(curve);
    // Four neighbours share the four texels above them: those whose middles lie around the corner of these.
    const ivec2 corner = ivec2(gl_GlobalInvocationID.xy);
    vec4 parents[4];
    [[unroll]] for (int i = 0; i < 4; ++i)
        parents[i] = kBand == kBandTop ? vec4(0.0) : imageLoad(above_image, clamp(corner - 1 + ivec2(i & 1, i >> 1), ivec2(0), ivec2(push.above_size) - 1));

    [[unroll]] for (int i = 0; i < 4; ++i) {
        const ivec2 at = 2 * corner - 1 + ivec2(i & 1, i >> 1);
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(push.size)))) continue;
        const vec2 right = (i & 1) != 0 ? vec2(0.25, 0.75) : vec2(0.75, 0.25), lower = (i >> 1) != 0 ? vec2(0.25, 0.75) : vec2(0.75, 0.25);
        const vec4 sum = lower.x * (right.x * parents[0] + right.y * parents[1]) + lower.y * (right.x * parents[2] + right.y * parents[3]);
        const vec3 above = sum.a > 0.0 ? sum.rgb / sum.a : vec3(0.0);

        const vec4 here = imageLoad(here_image, at);
        if (kBand == kBandFinest) {
            imageStore(shown_image, at, vec4(shown_pixel(tone, here.rgb, above), 1.0));
            continue;
        }
        const float ln_luminance = here.b, ln_curve = node_at(curve, tone, exp(ln_luminance)).r;
        const float ln_shown = kBand == kBandTop ? ln_curve : seen_under(above, ln_luminance);
        imageStore(shown_image, at, here.g > 0.0 ? handed_down(ln_luminance, ln_shown, ln_curve) : vec4(0.0));
    }
}
