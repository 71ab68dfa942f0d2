// What an adapted eye can just see, cd/m^2, after Ferwerda, Pattanaik, Shirley and Greenberg 1996. For adapt.comp.

const float kLn10 = 2.302585093;

float log10_of(float x) { return log(x) / kLn10; }
float power_of_ten(float x) { return exp(x * kLn10); }

// `weber`: log10 of the luminance from which Weber's law holds.
float cone_threshold(float luminance, float weber) {
    const float l = log10_of(luminance);
    return power_of_ten(l <= -2.6 ? -0.72 : l < weber ? pow(max(0.249 * l + 0.65, 0.0), 2.7) - 0.72 : l - 1.255);
}

float rod_threshold(float luminance, float weber) {
    const float l = log10_of(luminance);
    return power_of_ten(l <= -3.94 ? -2.86 : l < weber ? pow(max(0.405 * l + 1.6, 0.0), 2.18) - 2.86 : l - 0.395);
}

// Both, as Ward Larson, Rushmeier and Piatko 1997 merge them.
float human_threshold(float luminance, float cone_weber, float rod_weber) {
    if (luminance < 1.148e-4) return 1.38e-3;
    return log10_of(luminance) < -0.0184 ? rod_threshold(luminance, rod_weber) : cone_threshold(luminance, cone_weber);
}
