// Reinhard, Stark, Shirley and Ferwerda 2002, global; key and white from the frame after Reinhard 2003.
// Settings: key, white (cd/m^2, 0: the largest of the frame), 1 for both from the frame.

#define REINHARD_MAPPED

#ifdef OPERATOR_FRAMES

void reinhard_frame(Frame frame) {
    float key = parameters.settings[0].x;
    const float white = parameters.settings[0].y;
    const bool automatic = parameters.settings[0].z != 0.0;
    float scaled_white = (white > 0.0 ? white : max(frame.maximum, kLuminanceFloor)) * key / frame.log_average;
    if (automatic) {  // in powers of two
        find_percentiles(frame);
        const float low = percentile[0] / kLn2, stops = max(percentile[1] / kLn2 - low, 1e-3);
        key = 0.18 * exp2(2.0 * (2.0 * (log2(frame.log_average) - low) - stops) / stops);
        scaled_white = 1.5 * exp2(stops - 5.0);
    }
    made.block[0] = vec4(key / frame.log_average, 1.0 / (scaled_white * scaled_white), 0.0, 0.0);
}

#else

Mapped reinhard_mapped(samplerBuffer curve, Tone tone, vec3 rgb, float luminance) {
    const float x = tone.block[0].x * luminance;
    return Mapped(x * (1.0 + x * tone.block[0].y) / (1.0 + x), 1.0, 1.0);
}

#endif
