// The adapting eye: pigment and neural adaptation, exact for any time step (vision/eye.h). For adapt.comp.

// Retinal illuminance through the pupil of Moon and Spencer 1944, td.
float trolands(float luminance) {
    const float diameter = 4.9 - 3.0 * tanh(0.4 * log10_of(luminance));  // mm
    return luminance * 0.7853981634 * diameter * diameter;
}

// Memory of receptors that are adapted to a luminance at which their adapted threshold is `threshold`.
ReceptorMemory adapted(ReceptorParameters r, float luminance, float threshold) {
    const float q = threshold * r.factor / (luminance * r.response_step);
    const float sigma = luminance * 0.5 * (q - 2.0 + sqrt(max(q * q - 4.0 * q, 0.0)));
    const float pigment = r.bleach_trolands / (r.bleach_trolands + trolands(luminance));
    const float neural = log10_of(sigma * pigment / r.dark_sigma);
    return ReceptorMemory(pigment, r.fast_share * neural, (1.0 - r.fast_share) * neural);
}

// A weighted mean, so that no time leaves the last bit as it was.
float blend(float from, float to, float kept) { return from * kept + to * (1.0 - kept); }
vec3 blend(vec3 from, vec3 to, float kept) { return from * kept + to * (1.0 - kept); }

float approach(float from, float to, float time_constants) { return blend(from, to, exp(-time_constants)); }

// After `seconds` at that luminance.
ReceptorMemory after(ReceptorMemory memory, ReceptorParameters r, float luminance, float threshold, float seconds) {
    const ReceptorMemory goal = adapted(r, luminance, threshold);
    const float rate = (1.0 + trolands(luminance) / r.bleach_trolands) / r.bleach_seconds;
    return ReceptorMemory(approach(memory.pigment, goal.pigment, rate * seconds),
                          approach(memory.fast, goal.fast, seconds / r.fast_seconds),
                          approach(memory.slow, goal.slow, seconds / r.slow_seconds));
}

// Half saturation, cd/m^2.
float sigma_of(ReceptorParameters r, ReceptorMemory memory) {
    return r.dark_sigma * power_of_ten(memory.fast + memory.slow) / memory.pigment;
}

// Smallest visible difference at a luminance for receptors with half saturation sigma.
float mal_adapted_threshold(ReceptorParameters r, float luminance, float sigma) {
    const float reach = luminance + sigma;
    return r.response_step * reach * (reach / sigma);
}
