// Ward Larson, Rushmeier and Piatko 1997, as Radiance's pcond: clip votes that exceed their ceiling, again with the new
// total, until little is clipped; a linear scale where hardly anything is left.

#ifdef OPERATOR_FRAMES

const float kTolerance = 0.025;  // of the total: what may still be clipped, and what has to be left

shared float trimmed_node[kMaxBins + 1u];

// Threshold on the display, for somebody adapted to that very luminance.
float display_threshold(float luminance) {
    const float l = log10_of(luminance);
    if (parameters.ceiling == kCeilingLinear) return luminance;
    return power_of_ten(parameters.ceiling == kCeilingHuman ? human_log_threshold(l, parameters.cone_break, parameters.rod_break)
                                                            : cone_log_threshold(l, parameters.cone_break));
}

// Threshold over luminance on the display.
float display_contrast(float ln_luminance) {
    const float luminance = exp(ln_luminance);
    return display_threshold(luminance) / luminance;
}

// ln Ld at the upper edge of this invocation's step, as adjust() gives it. `share`: of this invocation's bin, `h` of its step.
// `average`: what a linear scale shows at the geometric middle of the display.
float trim(float share, float h, Thresholds eye, float average, out float lowest, out bool is_linear) {
    const uint mine = gl_LocalInvocationIndex;
    const float ln_low = log(parameters.display_low), ln_high = log(parameters.display_high), range = ln_high - ln_low;
    const float width = 1.0 / (parameters.bins_per_ln * float(parameters.steps_per_bin));
    const float ln_luminance = parameters.ln_low + (float(min(mine, steps() - 1u)) + 0.5) * width;
    const float luminance = exp(ln_luminance), contrast = scene_threshold(eye, luminance) / luminance;
    const vec2 ends = extremes_of(share > 0.0, float(mine));
    const float original = sum_of(h);

    is_linear = (ends.y - ends.x + 1.0) / parameters.bins_per_ln <= range;
    float left = h, here = ln_low;
    for (uint round = 0u; round < 200u && !is_linear; ++round) {
        const float total = sum_of(left);
        is_linear = total <= kTolerance * original;
        if (is_linear) break;
        here = ln_low + range * running_sum(left) / total;
        barrier();
        if (mine == 0u) trimmed_node[0] = ln_low;
        trimmed_node[mine + 1u] = here;
        barrier();
        const float most = total * width / range * display_contrast(0.5 * (trimmed_node[mine] + here)) / contrast;
        const float clipped = max(left - most, 0.0);
        left -= clipped;
        if (sum_of(clipped) <= kTolerance * total) break;
    }
    lowest = ln_low;
    if (is_linear) {
        const float middle = 0.5 * (ln_low + ln_high);
        const float shift = middle + log(display_contrast(middle)) - log(scene_threshold(eye, average));
        lowest = clamp(parameters.ln_low + shift, ln_low, ln_high);
        here = clamp(parameters.ln_low + float(mine + 1u) * width + shift, ln_low, ln_high);
    }
    return here;
}

void ward_frame(Frame frame) {
    const float h = per_step(frame.share);
    float lowest = log(parameters.display_low), here = lowest;
    const Thresholds eye = Thresholds(frame.cone_sigma, frame.rod_sigma / parameters.scotopic);
    if (!frame.empty) here = trim(frame.share, h, eye, frame.adaptation, lowest, made.under_full);
    write_smoothed_nodes(frame, here, lowest);
}

#endif
