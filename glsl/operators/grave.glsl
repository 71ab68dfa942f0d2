// Grave and Bremond 2008, reconstructed: a curve for the coarsest level of the pyramid. bands.comp maps contrast below it
// and gives luminance of the display, for the linear scale of its pixels.

#ifdef OPERATOR_FRAMES

void grave_frame(Frame frame) {
    adjusted_curve(frame);
    const float range = max(parameters.display_high - parameters.display_low, kLuminanceFloor);
    made.block[0] = vec4(parameters.display_low, 1.0 / range, 0.0, 0.0);
}

#endif
