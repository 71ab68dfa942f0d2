// Histogram adjustment after Ward Larson, Rushmeier and Piatko 1997: slopes of the curve (d ln Ld / d ln L) follow the
// histogram but stay under a ceiling, so that nothing becomes visible on the display that is invisible in the scene. The
// slopes are min(lambda h, c(Ld)), the fixed point of Ward's trimming. For a given lambda the curve is climbed from the
// display's darkest luminance, bin by bin; every invocation tries another lambda, until the curve ends at the brightest.
// For adapt.comp.

const float kSpread = 1e-5;      // share of the votes spread over all bins, so that no part of the curve is flat
const float kSteepest = 64.0;  // lambda goes no higher than this times plain equalization: tiny shares fade in and out
const uint kRounds = 3u;         // of kMaxBins candidates each

shared float share_of[kMaxBins];     // h
shared float contrast_of[kMaxBins];  // threshold over luminance of the scene, at the middles of the bins
shared uint best;

struct Thresholds {
    float cone_sigma, rod_sigma;  // of the eye
};

float scene_threshold(Thresholds eye, float luminance) {
    const float l = log10_of(luminance);
    if (parameters.ceiling == kCeilingLinear) return luminance;
    if (parameters.ceiling == kCeilingHuman) return power_of_ten(human_log_threshold(l, parameters.cone_break, parameters.rod_break));
    if (parameters.ceiling == kCeilingCones) return power_of_ten(cone_log_threshold(l, parameters.cone_break));
    const float cones = mal_adapted_threshold(parameters.cones, luminance, eye.cone_sigma);
    const float rods = mal_adapted_threshold(parameters.rods, luminance, eye.rod_sigma);
    return parameters.use_rods != 0u ? min(cones, rods) : cones;
}

// Threshold over luminance on the display, for somebody adapted to that very luminance.
float display_contrast(float ln_luminance) {
    const float l = ln_luminance / kLn10;
    if (parameters.ceiling == kCeilingLinear) return 1.0;
    const float threshold = parameters.ceiling == kCeilingHuman ? human_log_threshold(l, parameters.cone_break, parameters.rod_break)
                                                                : cone_log_threshold(l, parameters.cone_break);
    return power_of_ten(threshold - l);
}

// ln Ld at `until` bins, starting at `start` below the first. `here`: at the upper edge of this invocation's bin.
float climb(float lambda, float start, float until, out float here) {
    const float width = 1.0 / parameters.bins_per_ln;
    float y = start;
    here = start;
    for (uint bin = 0u; bin < parameters.bins; ++bin) {
        const float part = min(until - float(bin), 1.0);
        if (part <= 0.0) break;
        const float wanted = lambda * share_of[bin], contrast = contrast_of[bin];
        float slope = min(wanted, display_contrast(y) / contrast);
        slope = min(wanted, display_contrast(y + 0.5 * width * slope) / contrast);  // the ceiling counts in the middle of the bin
        slope = min(wanted, display_contrast(y + 0.5 * width * slope) / contrast);
        slope = min(wanted, display_contrast(y + 0.5 * width * slope) / contrast);
        y += slope * width * part;
        if (bin == gl_LocalInvocationIndex) here = y;
    }
    return y;
}

// Where between a and b what is climbed reaches `goal`: over ln lambda to the last bin, or over what is added to the start
// to `until`, with lambda at its limit. What is reached grows along the way, so the last candidate that is not beyond is the one.
float search(float a, float b, float goal, bool over_lambda, float ln_low, float limit, float until) {
    const uint mine = gl_LocalInvocationIndex;
    const float last = float(kMaxBins) - 1.0;
    for (uint round = 0u; round < kRounds; ++round) {
        const float x = mix(a, b, float(mine) / last);
        float here;
        const float reached = over_lambda ? climb(exp(x), ln_low, until, here) : climb(limit, ln_low + x, until, here);
        if (mine == 0u) best = 0u;
        barrier();
        if (reached <= goal) atomicMax(best, mine);
        barrier();
        const float from = float(best);
        const float low = mix(a, b, from / last), high = mix(a, b, min(from + 1.0, last) / last);
        a = low, b = high;
        barrier();
    }
    return a;
}

// ln Ld at the upper edge of this invocation's bin; `lowest`: at the lower edge of the first. `h`: share of the votes. `placed`: ln
// of the luminance that is shown where its visibility is that of the scene, if the range is not filled. `left_over`: what of
// the range is not used, before the curve is placed.
float adjust(float h, Thresholds eye, float placed, out float lowest, out bool under_full, out float left_over) {
    const uint bin = gl_LocalInvocationIndex;
    const float ln_low = log(parameters.display_low), ln_high = log(parameters.display_high);
    const float width = 1.0 / parameters.bins_per_ln, bins = float(parameters.bins);
    const float luminance = exp(parameters.ln_low + (float(min(bin, parameters.bins - 1u)) + 0.5) * width);
    share_of[bin] = h;
    contrast_of[bin] = scene_threshold(eye, luminance) / luminance;
    barrier();

    const float plain = (ln_high - ln_low) / width, limit = kSteepest * plain;
    float mine;
    const float highest = climb(limit, ln_low, bins, mine);
    under_full = highest <= ln_high;
    left_over = max(ln_high - highest, 0.0);
    lowest = ln_low;
    float lambda = limit;
    if (under_full) {
        // On a display half as bright as its white (Ferwerda et al. 1996).
        const float half_white = log(0.5 * parameters.display_high);
        const float goal = placed + half_white + log(display_contrast(half_white)) - log(scene_threshold(eye, exp(placed)));
        const float until = clamp((placed - parameters.ln_low) * parameters.bins_per_ln, 0.0, bins);
        lowest += search(0.0, left_over, goal, false, ln_low, limit, until);
    } else {
        lambda = exp(search(log(plain), log(limit), ln_high, true, ln_low, limit, bins));
    }
    climb(lambda, lowest, bins, mine);
    return mine;
}
