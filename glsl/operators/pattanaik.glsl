// Visual adaptation after Pattanaik, Tumblin, Yee and Greenberg 2000 (analysis/pattanaik.h): responses of cones and rods
// and the exponent of colour, as a table over ln luminance. Settings: the constant of the rods.

#define PATTANAIK_MAPPED

#ifdef OPERATOR_FRAMES

const float kDisplayCones = 25.0;  // cd/m^2 that the display's observer is adapted to
const float kWhiteOver = 5.0, kBlackOver = 5.0 / 32.0;  // reference luminances over the adaptation luminance

float hunt_cone_sigma(float a) {
    const float k = 1.0 / (5.0 * a + 1.0), k4 = k * k * k * k;
    return 12.9223 * a / (k4 * a + 0.171 * (1.0 - k4) * (1.0 - k4) * pow(a, 1.0 / 3.0));
}

float hunt_rod_sigma(float a) {
    const float j = 1.0 / (parameters.settings[0].x * a + 1.0), rest = 1.0 - j * j;
    return 2.5874 * a / (19000.0 * j * j * a + 0.2615 * rest * rest * rest * rest * pow(a, 1.0 / 6.0));
}

float excitation(float luminance, float sigma) { return pow(luminance / sigma, kResponsePower); }
float response(float luminance, float sigma) {
    const float x = excitation(luminance, sigma);
    return x / (1.0 + x);
}

float pigment_after(float pigment, float goal, float tau, float half_bleached, float seconds) {
    return approach(pigment, half_bleached / (half_bleached + goal), (1.0 + goal / half_bleached) / tau * seconds);
}

// `scotopic`: of the goal, scotopic cd/m^2.
PattanaikState lagging_after(PattanaikState before, float goal, float scotopic, float seconds, bool first) {
    if (first || !(before.cones > 0.0)) return PattanaikState(goal, scotopic, 2e6 / (2e6 + goal), 0.04 / (0.04 + scotopic));
    return PattanaikState(approach(before.cones, goal, seconds / 0.080), approach(before.rods, scotopic, seconds / 0.150),
                      pigment_after(before.cone_pigment, goal, 110.0, 2e6, seconds),
                      pigment_after(before.rod_pigment, scotopic, 400.0, 0.04, seconds));
}

// From responses of the eye to those of the display's observer: R scale + offset.
struct Appearance {
    float scale, offset;
    float unit;   // display luminance over its white is this times (R / (1 - R))^(1 / kResponsePower)
    float range;  // of the observer's responses, from black to white
};

Appearance appearance_of(PattanaikState eye, float cone_sigma, float rod_sigma) {
    const float display_sigma = hunt_cone_sigma(kDisplayCones);
    const float display_white = response(kWhiteOver * kDisplayCones, display_sigma), display_black = response(kBlackOver * kDisplayCones, display_sigma);
    const float white = eye.cone_pigment * response(kWhiteOver * eye.cones, cone_sigma) + eye.rod_pigment * response(kWhiteOver * eye.rods, rod_sigma);
    const float black = eye.cone_pigment * response(kBlackOver * eye.cones, cone_sigma) + eye.rod_pigment * response(kBlackOver * eye.rods, rod_sigma);
    const bool dimmed = white > display_white, raised = !dimmed && black < display_black;
    const float scale = dimmed || raised ? min((display_white - display_black) / (white - black), 1.0) : 1.0;
    const float from = dimmed ? white : raised ? black : 0.0, to = dimmed ? display_white : raised ? display_black : 0.0;
    return Appearance(scale, to - from * scale, display_sigma / (kWhiteOver * kDisplayCones), display_white - display_black);
}

// Node `index` of kMaxNodes + 1.
vec4 lagging_node(PattanaikState eye, uint index) {
    const float cone_sigma = hunt_cone_sigma(eye.cones), rod_sigma = hunt_rod_sigma(eye.rods);
    const Appearance as = appearance_of(eye, cone_sigma, rod_sigma);
    const float luminance = table_luminance(index);
    const float x = excitation(luminance, cone_sigma);
    const float cones = eye.cone_pigment * x / (1.0 + x), rods = eye.rod_pigment * response(parameters.scotopic * luminance, rod_sigma);
    const float exponent = eye.cone_pigment * kResponsePower * x / ((1.0 + x) * (1.0 + x)) / (as.range / log10_of(32.0));
    return vec4(as.scale * cones, exponent, as.scale * rods, 0.0);
}

void pattanaik_frame(Frame frame) {
    begin_table();
    made.pattanaik = lagging_after(made.pattanaik, frame.adaptation, frame.scotopic, parameters.seconds, frame.first);
    for (uint i = gl_LocalInvocationIndex; i <= kMaxNodes; i += kMaxBins) curve.node[i] = lagging_node(made.pattanaik, i);
    const float cone_sigma = hunt_cone_sigma(made.pattanaik.cones), rod_sigma = hunt_rod_sigma(made.pattanaik.rods);
    const Appearance as = appearance_of(made.pattanaik, cone_sigma, rod_sigma);
    made.block[0] = vec4(as.offset, as.unit, 0.0, 0.0);
}

#else

Mapped pattanaik_mapped(samplerBuffer curve, Tone tone, vec3 rgb, float luminance) {
    const vec4 node = node_at(curve, tone, luminance);
    const float rods = node_at(curve, tone, scotopic_of(rgb)).b;
    const float seen = clamp(node.r + rods + tone.block[0].x, 0.0, 0.9999999);
    // Far beyond white all is the same.
    const float shown = min(tone.block[0].y * pow(seen / (1.0 - seen), 1.0 / kResponsePower), 1000.0);
    return Mapped(shown, node.g, node.r / max(node.r + rods, 1e-30));
}

#endif
