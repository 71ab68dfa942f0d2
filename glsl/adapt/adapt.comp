#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Adaptation and tone curve, one workgroup, one invocation per bin and per step of the curve. The eye adapts to what it looks
// at; the model of the operator makes its curve or its parameters of that and of the histogram; the curve is smoothed over time.

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
layout(binding = 7, rgba32f) readonly uniform image2D colours;  // mean colours of tiles and their pixels; any image where there are none

#include "threshold.glsl"
#include "eye.glsl"
#include "reduce.glsl"
#include "adjust.glsl"
#include "trim.glsl"
#include "pattanaik.glsl"
#include "chroma.glsl"

shared float percentile[2];
shared float share_of[kMaxBins];  // of the votes, bin by bin

const float kBrightest = 1e6;  // cd/m^2 to which an eye adapts
const float kLeash = 0.25;     // ln of display luminance by which a curve that is smoothed over time lags behind at most

// ln of the luminances below which 1 and 99 % of the votes are. `share` of all `voters` is this invocation's bin's.
void find_percentiles(float share, float voters) {
    const uint bin = gl_LocalInvocationIndex;
    if (bin < 2u) percentile[bin] = parameters.ln_low;
    const float above = running_sum(share) / voters, below = above - share / voters;
    for (uint i = 0u; i < 2u; ++i) {
        const float part = i == 0u ? 0.01 : 0.99;
        if (below < part && above >= part) percentile[i] = parameters.ln_low + (float(bin) + (part - below) * voters / share) / parameters.bins_per_ln;
    }
    barrier();
}

// This invocation's step of the shares of all bins, seen through a window, a cubic B-spline; whole votes: its bin.
float per_step(float share) {
    const uint mine = gl_LocalInvocationIndex;
    if (parameters.window == 0.0) return share;
    share_of[mine] = share;
    barrier();
    const float at = (float(mine) + 0.5) / float(parameters.steps_per_bin) - 0.5, reach = 2.0 * parameters.window;  // in bins
    const uint from = uint(max(ceil(at - reach), 0.0)), until = mine < steps() ? uint(clamp(floor(at + reach) + 1.0, 0.0, float(parameters.bins))) : 0u;
    float sum = 0.0;
    for (uint i = from; i < until; ++i) {
        const float u = abs(at - float(i)) / parameters.window, edge = max(2.0 - u, 0.0);
        sum += share_of[i] * (u < 1.0 ? 2.0 / 3.0 - u * u * (1.0 - 0.5 * u) : edge * edge * edge / 6.0);
    }
    const float all = sum_of(sum);
    return all > 0.0 ? sum * sum_of(share) / all : 0.0;
}

// A node of the curve: what flickers is smoothed, what is another scene is not.
float follow(float from, float to, float kept) {
    return kept < 1.0 ? clamp(blend(from, to, kept), to - kLeash, to + kLeash) : from;
}

// Mean or log average of the finite pixels of 3 x 3 texels about the gaze, linear in its position; of none: -1.
float gaze_luminance() {
    const ivec2 last = ivec2(parameters.foveal_size) - 1;
    if (parameters.adapt_to == kAdaptTexel) {
        const vec2 texel = imageLoad(foveal_level, clamp(ivec2(floor(parameters.gaze)), ivec2(0), last)).rg;
        return texel.g > 0.0 ? texel.r : -1.0;
    }
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
    if (pixels == 0.0) return -1.0;
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
    const float otherwise = first ? log_average : previous.adaptation;  // where there is nothing to look at
    const float goal = empty || looked_at < 0.0 ? otherwise : looked_at;
    const float adaptation = clamp(goal, kLuminanceFloor, kBrightest);
    const float scotopic = parameters.scotopic * adaptation;
    const float l = log10_of(adaptation);
    const float cones_see = power_of_ten(cone_log_threshold(l, parameters.cone_break)), rods_see = power_of_ten(rod_log_threshold(log10_of(scotopic), parameters.rod_break));
    ReceptorMemory cones, rods;
    if (first) {
        cones = adapted(parameters.cones, adaptation, cones_see);
        rods = adapted(parameters.rods, scotopic, rods_see);
    } else {
        cones = after(previous.cones, parameters.cones, adaptation, cones_see, parameters.seconds);
        rods = after(previous.rods, parameters.rods, scotopic, rods_see, parameters.seconds);
    }
    const float cone_sigma = sigma_of(parameters.cones, cones), rod_sigma = sigma_of(parameters.rods, rods);
    const Thresholds eye = Thresholds(cone_sigma, rod_sigma / parameters.scotopic);  // of rods in luminance, as the histogram is

    const float share = bin < parameters.bins && !empty ? float(histogram.count[bin]) / float(histogram.votes) : 0.0;
    const float h = per_step(share);

    // Its nodes lie at the edges of the steps.
    const bool has_curve = kModel == kModelHistogram || kModel == kModelTrimmed;
    bool under_full = false;
    float left_over = 0.0;
    const float ln_display_low = log(parameters.display_low), steps_per_ln = parameters.bins_per_ln * float(parameters.steps_per_bin);
    float lowest = ln_display_low, here = ln_display_low;
    if (kModel == kModelHistogram && !empty) here = adjust(h, eye, lowest, under_full, left_over);
    if (kModel == kModelTrimmed && !empty) here = trim(share, h, eye, adaptation, lowest, under_full);
    // Over time every node follows, in ln Ld; what is empty, and a pause, leave it as it was.
    const float kept = empty ? 1.0 : parameters.smoothing_seconds > 0.0 ? exp(-parameters.seconds / parameters.smoothing_seconds) : 0.0;
    const bool same_steps = previous.steps == float(steps()) && previous.ln_low == parameters.ln_low && previous.steps_per_ln == steps_per_ln;
    if (has_curve && !first && same_steps) {
        here = follow(previous.node[bin + 1u], here, kept);
        lowest = follow(previous.node[0], lowest, kept);
    }
    if (kModel != kModelPattanaik && bin < steps()) curve.node[bin + 1u] = vec4(here, 0.0, 0.0, 0.0);
    if (kModel != kModelPattanaik && bin == 0u) curve.node[0] = vec4(lowest, 0.0, 0.0, 0.0);
    for (uint i = steps() + 1u + bin; kModel != kModelPattanaik && i <= kMaxNodes; i += kMaxBins) curve.node[i] = vec4(0.0);
    current.node[bin + 1u] = has_curve && bin < steps() ? here : 0.0;
    if (bin == 0u) current.node[0] = has_curve ? lowest : 0.0;
    PattanaikState pattanaik = previous.pattanaik;
    if (kModel == kModelPattanaik) {
        pattanaik = lagging_after(pattanaik, adaptation, scotopic, parameters.seconds, first);
        for (uint i = bin; i <= kMaxNodes; i += kMaxBins) curve.node[i] = lagging_node(pattanaik, i);
    }
    if (kModel == kModelFixed && parameters.automatic != 0u) find_percentiles(share, max(sum_of(share), 1e-30));
    vec3 chroma = previous.chroma;
    mat3 seen = mat3(1.0);
    if (kModel == kModelGains && parameters.colour_tiles.x > 0u) {
        const vec3 goal_chroma = looked_at_chroma(previous.chroma);
        chroma = first ? goal_chroma : blend(previous.chroma, goal_chroma, exp(-parameters.seconds / kSlowSeconds));
        seen = transpose(chromatic_adaptation(kAtOnce * goal_chroma + (1.0 - kAtOnce) * chroma, adaptation));
    }
    if (bin != 0u) return;

    float key = parameters.key;
    float scaled_white = (parameters.white > 0.0 ? parameters.white : max(maximum, kLuminanceFloor)) * key / log_average;
    if (kModel == kModelFixed && parameters.automatic != 0u) {  // Reinhard 2003, in powers of two
        const float low = percentile[0] / kLn2, stops = max(percentile[1] / kLn2 - low, 1e-3);
        key = 0.18 * exp2(2.0 * (2.0 * (log2(log_average) - low) - stops) / stops);
        scaled_white = 1.5 * exp2(stops - 5.0);
    }
    float linear_low = parameters.linear_low, linear_gain = 1.0 / max((parameters.linear_high > 0.0 ? parameters.linear_high : maximum) - linear_low, kLuminanceFloor);
    vec3 rod_light = vec3(0.0);
    if (kModel == kModelGains) {
        // Thresholds of the scene become those of the display: luminance of the display over that of the scene.
        const float shown = power_of_ten(cone_log_threshold(log10_of(0.5 * parameters.display_high), parameters.cone_break));
        const bool in_state = parameters.ceiling == kCeilingEye;
        const float cone_gain = shown / (in_state ? mal_adapted_threshold(parameters.cones, adaptation, cone_sigma) : cones_see * parameters.cones.factor);
        const float rod_gain = shown / (in_state ? mal_adapted_threshold(parameters.rods, scotopic, rod_sigma) : rods_see * parameters.rods.factor);
        const float rods_count = clamp(1.0 - (0.5 * adaptation - 0.01) / 9.99, 0.0, 1.0);
        linear_low = parameters.display_low / cone_gain;
        linear_gain = cone_gain / (parameters.display_high - parameters.display_low);
        rod_light = rods_count * rods_count * rod_gain * parameters.scotopic / cone_gain * parameters.rod_tint;
    }
    curve.reinhard_scale = key / log_average;
    curve.reinhard_white = 1.0 / (scaled_white * scaled_white);
    curve.linear_low = linear_low;
    curve.linear_gain = linear_gain;
    curve.rods = rod_light;
    curve.unused = 0.0;
    curve.red = vec4(seen[0], 0.0), curve.green = vec4(seen[1], 0.0), curve.blue = vec4(seen[2], 0.0);
    const bool own_table = kModel == kModelPattanaik;
    curve.ln_low = own_table ? kTableLow : parameters.ln_low;
    curve.bins_per_ln = own_table ? float(kMaxNodes) / (kTableHigh - kTableLow) : steps_per_ln;
    curve.bins = own_table ? float(kMaxNodes) : float(steps());
    curve.under_full = under_full ? 1.0 : 0.0;
    curve.adaptation = adaptation;
    curve.log_average = log_average;
    curve.maximum = maximum;
    curve.slack = left_over;
    curve.cone_sigma = cone_sigma;
    curve.rod_sigma = rod_sigma;
    curve.response_offset = 0.0, curve.response_unit = 0.0;
    if (kModel == kModelPattanaik) {
        const Appearance as = appearance_of(pattanaik, hunt_cone_sigma(pattanaik.cones), hunt_rod_sigma(pattanaik.rods));
        curve.response_offset = as.offset, curve.response_unit = as.unit;
    }
    current.adaptation = adaptation;
    // With what was lost before, so that time goes on as it should after days of it.
    precise const float passed = parameters.seconds + previous.seconds_lost, now = previous.seconds + passed;
    precise const float kept_back = now - previous.seconds, lost = passed - kept_back;
    current.seconds = min(now, kLongestLife), current.seconds_lost = lost;
    current.pupil = blend(previous.pupil > 0.0 ? previous.pupil : kFirstPupil, 4.9 - 3.0 * tanh(0.4 * l), exp(-parameters.seconds / kPupilSeconds));
    current.cones = cones;
    current.rods = rods;
    current.pattanaik = pattanaik;
    current.chroma = chroma;
    current.steps = has_curve ? float(steps()) : 0.0;
    current.ln_low = has_curve ? parameters.ln_low : 0.0;
    current.steps_per_ln = has_curve ? steps_per_ln : 0.0;
}
