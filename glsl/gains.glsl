// Linear gains of cones and rods: thresholds of the scene become those of the display. For ferwerda and durand, whose
// setting is the colour of the light that rods add.
//
// Numbers of a pixel: block[0] luminance shown as black, cd/m^2, and 1 / (white - black); block[1] the light that is added
// to it, times its scotopic luminance over that of white; block[2] to [4] the rows of its chromatic adaptation, in
// Rec. 709.
void gains_frame(Frame frame) {
    mat3 seen = mat3(1.0);
    if (parameters.colour_tiles.x > 0u) {
        const vec3 goal_chroma = looked_at_chroma(previous.chroma);
        const float kept = exp(-parameters.seconds / kSlowSeconds);
        made.chroma = frame.first ? goal_chroma : blend(previous.chroma, goal_chroma, kept);
        const vec3 mixed = kAtOnce * goal_chroma + (1.0 - kAtOnce) * made.chroma;
        seen = transpose(chromatic_adaptation(mixed, frame.adaptation));
    }
    // Luminance of the display over that of the scene.
    const float viewer = log10_of(0.5 * parameters.display_high);
    const float shown = power_of_ten(cone_log_threshold(viewer, parameters.cone_break));
    const bool in_state = parameters.ceiling == kCeilingEye;
    float cones_see = frame.cones_see * parameters.cones.factor, rods_see = frame.rods_see * parameters.rods.factor;
    if (in_state) {
        cones_see = mal_adapted_threshold(parameters.cones, frame.adaptation, frame.cone_sigma);
        rods_see = mal_adapted_threshold(parameters.rods, frame.scotopic, frame.rod_sigma);
    }
    const float cone_gain = shown / cones_see, rod_gain = shown / rods_see;
    const float rods_count = clamp(1.0 - (0.5 * frame.adaptation - 0.01) / 9.99, 0.0, 1.0);
    const float range = parameters.display_high - parameters.display_low;
    made.block[0] = vec4(parameters.display_low / cone_gain, cone_gain / range, 0.0, 0.0);
    const float rods_add = rods_count * rods_count * rod_gain * parameters.scotopic / cone_gain;
    made.block[1] = vec4(rods_add * parameters.settings[0].rgb, 0.0);
    for (int i = 0; i < 3; ++i) made.block[2 + i] = vec4(seen[i], 0.0);
}
