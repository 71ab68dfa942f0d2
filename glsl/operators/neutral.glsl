// Khronos PBR Neutral 2024, the curve that engines ship: colours of up to 0.8 are kept but for the 0.04 that a Fresnel
// reflection adds, brighter ones are compressed and go towards white. A baseline for comparison, not psychophysical.
// Settings: luminance of 1 before the curve, cd/m^2 (0: the log average is 0.18). Numbers of a pixel: block[0].x, its
// inverse.

vec3 neutral_light(float scale, vec3 rgb) {
    const float start = 0.8 - 0.04, desaturation = 0.15;
    vec3 colour = max(scale * rgb, vec3(0.0));
    const float least = min(colour.r, min(colour.g, colour.b));
    colour -= least < 0.08 ? least - 6.25 * least * least : 0.04;
    const float peak = max(colour.r, max(colour.g, colour.b));
    if (peak < start) return colour;
    const float room = 1.0 - start, shown = 1.0 - room * room / (peak + room - start);
    return mix(vec3(shown), colour * (shown / peak), 1.0 / (desaturation * (peak - shown) + 1.0));
}

#define NEUTRAL_RGB

#ifdef OPERATOR_FRAMES

void neutral_frame(Frame frame) {
    const float white = parameters.settings[0].x;
    made.block[0] = vec4(white > 0.0 ? 1.0 / white : 0.18 / frame.log_average, 0.0, 0.0, 0.0);
    begin_table();
    for (uint i = gl_LocalInvocationIndex; i <= kMaxNodes; i += kMaxBins)
        curve.node[i] = node_of(neutral_light(made.block[0].x, vec3(table_luminance(i))).g);
}

#else

vec3 neutral_rgb(Tone tone, vec3 rgb) { return neutral_light(tone.block[0].x, rgb); }

#endif
