// Drago, Myszkowski, Annen and Chiba 2003: logarithms whose base goes from 2 for dark pixels to 10 for the brightest.
// Settings: the exponent that moves the base, ln(bias) / ln(0.5).

#ifdef OPERATOR_FRAMES

// ln(1 + x), also where 1 + x has lost x.
float ln_of_one_and(float x) { return x < 1e-3 ? x - 0.5 * x * x : log(1.0 + x); }

// Eq. 4 with Ldmax 100: relative to white. `x` and `most` are over the log average.
float drago_shown(float x, float most) {
    const float base = 2.0 + 8.0 * pow(min(x / most, 1.0), parameters.settings[0].x);
    return ln_of_one_and(x) / log(base) * (kLn10 / ln_of_one_and(most));
}

void drago_frame(Frame frame) {
    begin_table();
    const float most = max(frame.maximum, kLuminanceFloor) / frame.log_average;
    for (uint i = gl_LocalInvocationIndex; i <= kMaxNodes; i += kMaxBins)
        curve.node[i] = node_of(drago_shown(table_luminance(i) / frame.log_average, most));
}

#endif
