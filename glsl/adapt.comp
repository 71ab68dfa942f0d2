#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Adaptation and tone curve, one workgroup, one thread per bin. Histogram adjustment after Ward, Rushmeier and Piatko
// 1997: slopes of the curve (d ln Ld / d ln Lw) follow the histogram but stay under a ceiling, so that nothing becomes
// visible on the display that is invisible in the scene. The slopes min(lambda h, c) that fill the display range are the
// fixed point of Ward's trimming; lambda is found exactly. The ceilings depend on the curve, so this is iterated.

#include "shared/photometry.h"
#include "shared/tone.h"

layout(local_size_x = kMaxBins) in;

layout(binding = 0, rgba32f) readonly uniform image2D top_level;  // 1x1: statistics of the whole frame
layout(binding = 1, scalar) readonly buffer Counts { Histogram histogram; };
layout(binding = 2, scalar) readonly buffer Previous { EyeState previous; };
layout(binding = 3, scalar) writeonly buffer Current { EyeState current; };
layout(binding = 4, scalar) writeonly buffer Curve { ToneCurve curve; };
layout(push_constant, scalar) uniform Push { AdaptPush push; };

const uint kIterations = 24u;
const float kSpread = 1e-4;  // share of the votes spread over the occupied range, so that no bin in it is flat

shared float share[kMaxBins];       // h: share of the votes
shared float ceiling[kMaxBins];     // c: largest slope
shared float node[kMaxBins + 1u];   // ln of display luminance at the edges of the bins
shared float scratch[kMaxBins];

// Threshold of the cones, cd/m^2 (Ferwerda et al. 1996, published break points).
float cone_threshold(float luminance) {
    const float l = log(luminance) / log(10.0);
    const float t = l <= -2.6 ? -0.72 : l < 1.9 ? pow(0.249 * l + 0.65, 2.7) - 0.72 : l - 1.255;
    return pow(10.0, t);
}

float sum_of(float value) {
    const uint bin = gl_LocalInvocationIndex;
    barrier();
    scratch[bin] = value;
    for (uint half_ = kMaxBins / 2u; half_ > 0u; half_ /= 2u) {
        barrier();
        if (bin < half_) scratch[bin] += scratch[bin + half_];
    }
    barrier();
    return scratch[0];
}

float largest_of(float value) {
    const uint bin = gl_LocalInvocationIndex;
    barrier();
    scratch[bin] = value;
    for (uint half_ = kMaxBins / 2u; half_ > 0u; half_ /= 2u) {
        barrier();
        if (bin < half_) scratch[bin] = max(scratch[bin], scratch[bin + half_]);
    }
    barrier();
    return scratch[0];
}

// Sum over this bin and those below.
float running_sum(float value) {
    const uint bin = gl_LocalInvocationIndex;
    barrier();
    scratch[bin] = value;
    for (uint step = 1u; step < kMaxBins; step *= 2u) {
        barrier();
        const float left = bin >= step ? scratch[bin - step] : 0.0;
        barrier();
        scratch[bin] += left;
    }
    barrier();
    return scratch[bin];
}

// Slopes min(lambda h, c) that add up to `wanted`, or c where even those do not reach it (then `under_full`).
float water_filling(float wanted, out bool under_full) {
    const uint bin = gl_LocalInvocationIndex;
    const float h = share[bin], c = ceiling[bin];
    const float ratio = h > 0.0 ? c / h : 0.0;
    under_full = sum_of(h > 0.0 ? c : 0.0) <= wanted;
    if (under_full) return h > 0.0 ? c : 0.0;
    float filled = 0.0;  // by lambda = ratio
    const uint bins = h > 0.0 ? push.bins : 0u;
    for (uint i = 0u; i < bins; ++i) filled += min(ratio * share[i], ceiling[i]);
    const float full = largest_of(h > 0.0 && filled <= wanted ? ratio : 0.0);
    const bool at_ceiling = h > 0.0 && ratio <= full;
    const float spent = sum_of(at_ceiling ? c : 0.0);
    const float open_share = sum_of(at_ceiling ? 0.0 : h);
    const float lambda = open_share > 0.0 ? max(wanted - spent, 0.0) / open_share : full;
    return at_ceiling ? c : min(lambda * h, c);
}

void main() {
    const uint bin = gl_LocalInvocationIndex;
    const vec4 frame = imageLoad(top_level, ivec2(0));
    const bool empty = histogram.finite == 0u;
    const float log_average = empty ? kLuminanceFloor : max(exp(frame.b), kLuminanceFloor);
    const float maximum = frame.a;
    const float ln_display_low = log(push.display_low);
    const float range = log(push.display_high) - ln_display_low;
    const float width = 1.0 / push.bins_per_ln;

    // Votes, and a little of them spread over the occupied range.
    const uint count = bin < push.bins ? histogram.count[bin] : 0u;
    const float last = largest_of(count > 0u ? float(bin) : -1.0);
    const float first = -largest_of(count > 0u ? -float(bin) : -float(kMaxBins));
    const bool occupied = !empty && float(bin) >= first && float(bin) <= last;
    share[bin] = occupied ? (float(count) / float(histogram.finite) + kSpread / (last - first + 1.0)) / (1.0 + kSpread) : 0.0;

    const float luminance = exp(push.ln_low + (float(bin) + 0.5) * width);
    const float scene_contrast = cone_threshold(luminance) / luminance;
    const float adapted = log(log_average);
    const float adapted_bin = clamp((adapted - push.ln_low) * push.bins_per_ln, 0.0, float(push.bins));
    const float display_adaptation = 0.5 * push.display_high;
    const float matched =
        adapted + log(cone_threshold(display_adaptation)) - log(cone_threshold(log_average));

    float mine = ln_display_low + running_sum(range * share[bin]);  // node above this bin
    if (bin == 0u) node[0] = ln_display_low;
    node[bin + 1u] = mine;
    bool under_full = false;
    float left_over = 0.0;
    for (uint iteration = 0u; iteration < kIterations; ++iteration) {
        barrier();
        const float shown = exp(0.5 * (node[bin] + node[bin + 1u]));
        const float lowest = node[0];
        ceiling[bin] = cone_threshold(shown) / shown / scene_contrast;
        barrier();
        const float slope = water_filling(range * push.bins_per_ln, under_full);  // every thread: it has barriers
        const float above = running_sum(slope * width);
        const float filled = scratch[kMaxBins - 1u];
        left_over = under_full ? max(range - filled, 0.0) : 0.0;
        // Where the range is not filled, the adaptation luminance is shown at the luminance that matches its visibility.
        const uint under = uint(min(adapted_bin, float(push.bins) - 1.0));
        const float below = under > 0u ? scratch[under - 1u] : 0.0;
        const float at_adaptation = below + (adapted_bin - float(under)) * (scratch[under] - below);
        const float offset = clamp(matched - ln_display_low - at_adaptation, 0.0, left_over);
        mine = 0.5 * (mine + ln_display_low + offset + above);
        barrier();
        if (bin == 0u) node[0] = 0.5 * (lowest + ln_display_low + offset);
        node[bin + 1u] = mine;
    }
    barrier();

    const float shown_low = empty ? ln_display_low : node[0];
    curve.node[bin + 1u] = empty || bin >= push.bins ? ln_display_low : node[bin + 1u];
    if (bin != 0u) return;
    curve.node[0] = shown_low;
    const float white = push.white > 0.0 ? push.white : max(maximum, kLuminanceFloor);
    const float scaled_white = push.key / log_average * white;
    const float high = push.linear_high > 0.0 ? push.linear_high : maximum;
    curve.adaptation = log_average;
    curve.log_average = log_average;
    curve.maximum = maximum;
    curve.reinhard_scale = push.key / log_average;
    curve.reinhard_white = 1.0 / (scaled_white * scaled_white);
    curve.linear_low = push.linear_low;
    curve.linear_gain = 1.0 / max(high - push.linear_low, kLuminanceFloor);
    curve.ln_low = push.ln_low;
    curve.bins_per_ln = push.bins_per_ln;
    curve.bins = float(push.bins);
    curve.ceiling = under_full ? 1.0 : 0.0;
    curve.slack = left_over;
    current.adaptation = log_average;
    current.seconds = previous.seconds + push.seconds;
}
