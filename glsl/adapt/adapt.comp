#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Adaptation and tone curve, one workgroup, one invocation per bin and per step of the curve. The eye adapts to the light
// where it looks; the operator turns that, the histogram and the statistics of the frame into a table or numbers.

#include "shared/photometry.h"
#include "shared/tone.h"

layout(local_size_x = kMaxBins) in;
layout(constant_id = 0) const uint kOperator = 0u;  // its value in vesper/operators.h

layout(binding = 0, rgba32f) readonly uniform image2D top_level;  // 1x1: statistics of the whole frame
layout(binding = 1, rgba32f) readonly uniform image2D foveal_level;
layout(binding = 2, scalar) readonly buffer Counts { Histogram histogram; };
layout(binding = 3, scalar) readonly buffer Settings { ToneParameters parameters; };
layout(binding = 4, scalar) readonly buffer Previous { EyeState previous; };
layout(binding = 5, scalar) writeonly buffer Current { EyeState current; };
layout(binding = 6, scalar) writeonly buffer Curve { ToneCurve curve; };
// Mean colours of tiles and their pixels; any image where the operator does not adapt to colour.
layout(binding = 7, rgba32f) readonly uniform image2D colours;

#include "threshold.glsl"
#include "eye.glsl"
#include "reduce.glsl"
#include "frame.glsl"
#include "adjust.glsl"
#include "chroma.glsl"
#include "gains.glsl"
#define OPERATOR_FRAMES
#include "operators_frames.glsl"

const float kBrightest = 1e6;  // cd/m^2 to which an eye adapts

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
    const vec4 whole = imageLoad(top_level, ivec2(0));
    const bool empty = histogram.finite == 0u;
    const float log_average = empty ? kLuminanceFloor : exp(whole.b);
    const float maximum = whole.a;

    // The luminance that the eye looks at, and the state that it brings the eye to.
    const bool first = !(previous.adaptation > 0.0);
    const float looked_at = parameters.adapt_to == kAdaptAverage ? log_average : gaze_luminance();
    const float otherwise = first ? log_average : previous.adaptation;  // where there is nothing to look at
    const float goal = empty || looked_at < 0.0 ? otherwise : looked_at;
    const float adaptation = clamp(goal, kLuminanceFloor, kBrightest);
    const float scotopic = parameters.scotopic * adaptation;
    const float l = log10_of(adaptation);
    const float cones_see = power_of_ten(cone_log_threshold(l, parameters.cone_break));
    const float rods_see = power_of_ten(rod_log_threshold(log10_of(scotopic), parameters.rod_break));
    ReceptorMemory cones, rods;
    if (first) {
        cones = adapted(parameters.cones, adaptation, cones_see);
        rods = adapted(parameters.rods, scotopic, rods_see);
    } else {
        cones = after(previous.cones, parameters.cones, adaptation, cones_see, parameters.seconds);
        rods = after(previous.rods, parameters.rods, scotopic, rods_see, parameters.seconds);
    }
    const float cone_sigma = sigma_of(parameters.cones, cones), rod_sigma = sigma_of(parameters.rods, rods);
    const float share = bin < parameters.bins && !empty ? float(histogram.count[bin]) / float(histogram.votes) : 0.0;

    begin_frame();
    operator_frame(Frame(empty, first, log_average, whole.r, maximum, adaptation, scotopic, cones_see, rods_see, cone_sigma,
                         rod_sigma, share));
    end_nodes();
    if (bin != 0u) return;

    curve.block = made.block;
    curve.ln_low = made.ln_low;
    curve.bins_per_ln = made.steps_per_ln;
    curve.bins = made.steps;
    curve.under_full = made.under_full ? 1.0 : 0.0;
    curve.adaptation = adaptation;
    curve.log_average = log_average;
    curve.maximum = maximum;
    curve.slack = made.left_over;
    curve.cone_sigma = cone_sigma;
    curve.rod_sigma = rod_sigma;
    curve.unused = vec2(0.0);
    current.adaptation = adaptation;
    // With the seconds that rounding lost before, so that time goes on as it should after days of it.
    precise const float passed = parameters.seconds + previous.seconds_lost, now = previous.seconds + passed;
    precise const float kept_back = now - previous.seconds, lost = passed - kept_back;
    current.seconds = min(now, kLongestLife), current.seconds_lost = lost;
    current.pupil = blend(previous.pupil > 0.0 ? previous.pupil : kFirstPupil, 4.9 - 3.0 * tanh(0.4 * l), exp(-parameters.seconds / kPupilSeconds));
    current.cones = cones;
    current.rods = rods;
    current.pattanaik = made.pattanaik;
    current.chroma = made.chroma;
    current.steps = made.smoothed ? made.steps : 0.0;
    current.ln_low = made.smoothed ? made.ln_low : 0.0;
    current.steps_per_ln = made.smoothed ? made.steps_per_ln : 0.0;
}
