// What an adapted eye can just see, after Ferwerda, Pattanaik, Shirley and Greenberg 1996: log10 of thresholds over
// l = log10 of luminance, cd/m^2. For adapt.comp.

const float kLn10 = 2.302585093, kLn2 = 0.6931471806;

float log10_of(float x) { return log(x) / kLn10; }
float power_of_ten(float x) { return exp(x * kLn10); }

// `weber`: l from which Weber's law holds.
float cone_log_threshold(float l, float weber) {
    return l <= -2.6 ? -0.72 : l < weber ? pow(max(0.249 * l + 0.65, 0.0), 2.7) - 0.72 : l - 1.255;
}

float rod_log_threshold(float l, float weber) {
    return l <= -3.94 ? -2.86 : l < weber ? pow(max(0.405 * l + 1.6, 0.0), 2.18) - 2.86 : l - 0.395;
}

// Both, as Ward Larson, Rushmeier and Piatko 1997 merge them: not below 1.38e-3 cd/m^2, that of 1.148e-4 cd/m^2.
float human_log_threshold(float l, float cone_weber, float rod_weber) {
    if (l < -3.940058) return -2.8601209;
    return l < -0.0184 ? rod_log_threshold(l, rod_weber) : cone_log_threshold(l, cone_weber);
}
