// Ferwerda, Pattanaik, Shirley and Greenberg 1996: linear gains of cones and rods.

#define FERWERDA_SEEN
#define FERWERDA_MAPPED

#ifdef OPERATOR_FRAMES

void ferwerda_frame(Frame frame) { gains_frame(frame); }

#else

vec3 ferwerda_seen(Tone tone, vec3 rgb) {
    const mat3 colour = transpose(mat3(tone.block[2].rgb, tone.block[3].rgb, tone.block[4].rgb));
    return colour * rgb + scotopic_of(rgb) * tone.block[1].rgb;
}

Mapped ferwerda_mapped(samplerBuffer curve, Tone tone, vec3 rgb, float luminance) {
    return Mapped((luminance - tone.block[0].x) * tone.block[0].y, 1.0, 1.0);
}

#endif
