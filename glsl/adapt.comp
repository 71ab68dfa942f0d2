#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Adaptation and tone curve, one workgroup, one invocation per bin. The eye adapts to what it looks at; the histogram is
// smoothed over time; the model of the operator makes its curve or its parameters of both.

#include "shared/photometry.h"
#include "shared/tone.h"

layout(local_size_x = kMaxBins) in;
layout(constant_id = 0) const uint kModel = kModelHistogram;

layout(binding = 0, rgba32f) readonly uniform image2D top_level;  // 1x1: statistics of the whole frame
layout(binding = 1, rgba32f) readonly uniform image2D foveal_level;
layout(binding = 2, scalar) readonly buffer Counts { Histogram histogram; };
layout(binding = 3, scalar) readonly buffer Settings { ToneParameters parameters; };
layout(binding = 4, scalar) readonly buffer Previous { EyeState previous; };
layout(binding = 5, scalar) writeonly buffer Current { EyeState current; };
layout(binding = 6, scalar) writeonly buffer Curve { ToneCurve curve; };

#include "threshold.glsl"
#include "eye.glsl"
#include "reduce.glsl"
#include "adjust.glsl"
#include "trim.glsl"

const float kBrightest = 1e6;  // cd/m^2 to which an eye adapts

// Mean or log average of the finite pixels of 3 x 3 texels about the gaze, linear in its position; of none: 0.
float gaze_luminance() {
    const ivec2 last = ivec2(parameters.foveal_size) - 1;
    if (parameters.adapt_to == kAdaptTexel)
        return imageLoad(foveal_level, clamp(ivec2(floor(parameters.gaze)), ivec2(0), last)).r;
    const vec2 at = parameters.gaze - 0.5, base = floor(at), part = at - base;
    float sum = 0.0, pixels = 0.0;
    for (int y = -1; y <= 2; ++y)
        for (int x = -1; x <= 2; ++x) {
            const ivec2 texel = ivec2(base) + ivec2(x, y);
            if (any(lessThan(texel, ivec2(0))) || any(greaterThan(texel, last))) continue;
            const vec4 s = imageLoad(foveal_level, texel);
            const float weight = (x < 0 ? 1.0 - part.x : x > 1 ? part.x : 1.0) * (y < 0 ? 1.0 - part.y : y > 1 ? part.y : 1.0) * s.g;
            sum += weight * (parameters.adapt_to == kAdaptGaze ? s.b : s.r);
            pixels += weight;
        }
    if (pixels == 0.0) return 0.0;
    return parameters.adapt_to == kAdaptGaze ? exp(sum / pixels) : sum / pixels;
}

void main() {
    const uint bin = gl_LocalInvocationIndex;
    const vec4 frame = imageLoad(top_level, ivec2(0));
    const bool empty = histogram.finite == 0u;
    const float log_average = empty ? kLuminanceFloor : exp(frame.b);
    const float maximum = frame.a;

    // What the eye looks at, and what that makes of it.
    const bool first = !(previous.adaptation > 0.0);
    const float looked_at = parameters.adapt_to == kAdaptAverage ? log_average : gaze_luminance();
    const float goal = empty && !first ? previous.adaptation : looked_at;
    const float adaptation = clamp(goal, kLuminanceFloor, kBrightest);
    const float l = log10_of(adaptation);
    const float cones_see = power_of_ten(cone_log_threshold(l, parameters.cone_break)), rods_see = power_of_ten(rod_log_threshold(l, parameters.rod_break));
    ReceptorMemory cones, rods;
    if (first) {
        cones = adapted(parameters.cones, adaptation, cones_see);
        rods = adapted(parameters.rods, adaptation, rods_see);
    } else {
        cones = after(previous.cones, parameters.cones, adaptation, cones_see, parameters.seconds);
        rods = after(previous.rods, parameters.rods, adaptation, rods_see, parameters.seconds);
    }
    const Thresholds eye = Thresholds(sigma_of(parameters.cones, cones), sigma_of(parameters.rods, rods));

    // The smoothed histogram.
    const bool same_bins = previous.bins == float(parameters.bins) && previous.ln_low == parameters.ln_low && previous.bins_per_ln == parameters.bins_per_ln;
    const bool remembers = !first && same_bins;
    const float kept = parameters.smoothing_seconds > 0.0 ? exp(-parameters.seconds / parameters.smoothing_seconds) : 0.0;
    const float remembered = remembers ? previous.share[bin] : 0.0;
    const float now = bin < parameters.bins && !empty ? float(histogram.count[bin]) / float(histogram.votes) : 0.0;
    const float share = empty ? remembered : remembers ? blend(remembered, now, kept) : now;
    const float ln_adaptation = log(adaptation);
    const float placed = first ? ln_adaptation : blend(previous.ln_placed, ln_adaptation, kept);
    const float voters = sum_of(share);

    // Its nodes lie at the edges of the bins.
    bool under_full = false;
    float left_over = 0.0;
    const float ln_display_low = log(parameters.display_low);
    float lowest = ln_display_low, here = ln_display_low;
    if (kModel == kModelHistogram && voters > 0.0) {
        const float spread = bin < parameters.bins ? kSpread / float(parameters.bins) : 0.0;
        here = adjust((share + spread) / (1.0 + kSpread), eye, placed, lowest, under_full, left_over);
    }
    if (kModel == kModelTrimmed && voters > 0.0) here = trim(share, eye, placed, lowest, under_full);
    if (bin < parameters.bins) curve.node[bin + 1u] = vec4(here, 0.0, 0.0, 0.0);
    if (bin == 0u) curve.node[0] = vec4(lowest, 0.0, 0.0, 0.0);
    for (uint i = parameters.bins + 1u + bin; i <= kMaxNodes; i += kMaxBins) curve.node[i] = vec4(0.0);
    current.share[bin] = share;
    if (bin != 0u) return;

    const float white = parameters.white > 0.0 ? parameters.white : max(maximum, kLuminanceFloor);
    const float scale = parameters.key / log_average, scaled_white = scale * white;
    const float high = parameters.linear_high > 0.0 ? parameters.linear_high : maximum;
    curve.reinhard_scale = scale;
    curve.reinhard_white = 1.0 / (scaled_white * scaled_white);
    curve.linear_low = parameters.linear_low;
    curve.linear_gain = 1.0 / max(high - parameters.linear_low, kLuminanceFloor);
    curve.ln_low = parameters.ln_low;
    curve.bins_per_ln = parameters.bins_per_ln;
    curve.bins = float(parameters.bins);
    curve.under_full = under_full ? 1.0 : 0.0;
    curve.adaptation = adaptation;
    curve.log_average = log_average;
    curve.maximum = maximum;
    curve.slack = left_over;
    curve.cone_sigma = eye.cone_sigma;
    curve.rod_sigma = eye.rod_sigma;
    curve.unused[0] = 0.0, curve.unused[1] = 0.0;
    current.adaptation = adaptation;
    current.seconds = previous.seconds + parameters.seconds;
    current.cones = cones;
    current.rods = rods;
    current.ln_placed = placed;
    current.bins = float(parameters.bins);
    current.ln_low = parameters.ln_low;
    current.bins_per_ln = parameters.bins_per_ln;
}
