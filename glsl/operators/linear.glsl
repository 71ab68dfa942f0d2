// Linear between two luminances. Settings: those shown as black and as white, cd/m^2; white 0 is the largest of the frame.

#define LINEAR_MAPPED

#ifdef OPERATOR_FRAMES

void linear_frame(Frame frame) {
    const float low = parameters.settings[0].x, high = parameters.settings[0].y;
    made.block[0] = vec4(low, 1.0 / max((high > 0.0 ? high : frame.maximum) - low, kLuminanceFloor), 0.0, 0.0);
}

#else

Mapped linear_mapped(samplerBuffer curve, Tone tone, vec3 rgb, float luminance) {
    return Mapped((luminance - tone.block[0].x) * tone.block[0].y, 1.0, 1.0);
}

#endif
