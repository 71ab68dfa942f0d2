// Histogram adjustment after Ward Larson, Rushmeier and Piatko 1997: slopes of the curve (d ln Ld / d ln L) follow the
// histogram but stay under a ceiling, so that nothing becomes visible on the display that is invisible in the scene: no more
// just noticeable differences, dJ = dL / T, on the display than in the scene. The slopes are min(lambda h, c(Ld)), the fixed
// point of Ward's trimming. For a given lambda the curve is climbed from the display's darkest luminance, step by step;
// invocations try different lambdas, until the curve ends at the brightest. For adapt.comp.

const float kSpread = 1e-5;      // share of the votes spread over all steps, so that no part of the curve is flat
const float kSteepest = 64.0;    // lambda goes no higher than this times plain equalization: tiny shares fade in and out
const float kCounts = 1e-4;      // share of the votes that opens a gap as far as may be
const uint kCandidates = 32u;    // a round of the search tries so many, and the next is between two of them
const uint kRounds = 5u;

shared float share_of[kMaxBins];        // h, times the width of a step
shared float differences_in[kMaxBins];  // just noticeable differences of the scene in a step
shared vec2 gap_at[kMaxBins];           // part of its ceiling that a step with few votes or none may have, on the way up and down
shared float shown_at[kMaxBins + 1u];   // cd/m^2 at the edges of the steps
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

// Threshold on the display, for somebody adapted to that very luminance.
float display_threshold(float luminance) {
    const float l = log10_of(luminance);
    if (parameters.ceiling == kCeilingLinear) return luminance;
    return power_of_ten(parameters.ceiling == kCeilingHuman ? human_log_threshold(l, parameters.cone_break, parameters.rod_break)
                                                            : cone_log_threshold(l, parameters.cone_break));
}

// A part of step i, negative on the way down; `open` of what the votes leave of the ceiling. That is the midpoint rule for dL
// and, twice, for d ln L: exact where T is constant, and of fourth order where it is proportional to L.
float advance(float from, uint i, float part, float lambda, float open) {
    const float least = 0.5 * parameters.display_low;
    const float seen = part * differences_in[i], half_way = max(from + 0.5 * seen * display_threshold(from), least);
    const float rise = seen * display_threshold(half_way);
    const float most = max(from + rise / 3.0 * (1.0 + 2.0 * from / max(half_way - 0.5 * rise, 0.25 * from)), least);
    const float wanted = from * exp(lambda * share_of[i] * part);
    const float base = part > 0.0 ? min(wanted, most) : max(wanted, most);
    return base + open * (most - base);
}

uint steps() { return parameters.bins * parameters.steps_per_bin; }

// From a position to another one, in steps. `counted`: gaps that nobody is on the other side of stay closed. `keeps`: the edges passed.
float up(float at, float from, float until, float lambda, float open, bool counted, bool keeps) {
    for (uint i = uint(at); i < steps() && float(i) < until; ++i) {
        from = advance(from, i, min(until, float(i) + 1.0) - max(at, float(i)), lambda, counted ? open * gap_at[i].x : open);
        if (keeps) shown_at[i + 1u] = from;
    }
    return from;
}

float down(float at, float from, float lambda, float open, bool counted, bool keeps) {
    for (uint i = uint(ceil(at)); i > 0u; --i) {
        from = advance(from, i - 1u, float(i - 1u) - min(at, float(i)), lambda, counted ? open * gap_at[i - 1u].y : open);
        if (keeps) shown_at[i - 1u] = from;
    }
    return from;
}

struct Placing {
    float limit;  // of lambda
    float at;     // position of what the eye looks at
    float want;   // luminance it should be shown with
    float there;  // that it is shown with
};

const uint kOverLambda = 0u;  // ln lambda; the curve should end at the display's brightest
const uint kOverStart = 1u;   // ln of the luminance that the curve starts with
const uint kOverAbove = 2u;   // what is open above and below
const uint kOverBelow = 3u;

bool is_beyond(uint over, float x, Placing p) {
    const float last = float(steps()), low = parameters.display_low, high = parameters.display_high;
    if (over == kOverLambda) return up(0.0, low, last, exp(x), 0.0, true, false) > high;
    if (over == kOverAbove) return up(p.at, p.there, last, p.limit, x, true, false) > high;
    if (over == kOverBelow) return down(p.at, p.there, p.limit, x, true, false) < low;
    const float there = up(0.0, exp(x), p.at, p.limit, 0.0, true, false);
    return there > p.want || up(p.at, there, last, p.limit, 0.0, true, false) > high;
}

// The last x from a to b from which on is_beyond.
float search(uint over, float a, float b, Placing p) {
    const uint mine = gl_LocalInvocationIndex;
    const float last = float(kCandidates) - 1.0;
    for (uint round = 0u; round < kRounds; ++round) {
        if (mine == 0u) best = 0u;
        barrier();
        if (mine < kCandidates)
            if (!is_beyond(over, mix(a, b, float(mine) / last), p)) atomicMax(best, mine);
        barrier();
        const float from = float(best);
        const float low = mix(a, b, from / last), high = mix(a, b, min(from + 1.0, last) / last);
        a = low, b = high;
        barrier();
    }
    return a;
}

// ln Ld at the upper edge of this invocation's step; `lowest`: at the lower edge of the first. `h`: share of the votes. `left_over`:
// what of the range is not used by votes. It first places the curve: what the eye looks at is as visible as on a display
// half as bright as white (Ferwerda et al. 1996), if what there is fits; and then opens what has few votes or none between there
// and the farthest votes, above and below, up to the ceilings.
float adjust(float h, Thresholds eye, float adaptation, out float lowest, out bool under_full, out float left_over) {
    const uint mine = gl_LocalInvocationIndex, count = steps();
    const float low = parameters.display_low, high = parameters.display_high, last = float(count);
    const float width = 1.0 / (parameters.bins_per_ln * float(parameters.steps_per_bin));
    const float luminance = exp(parameters.ln_low + (float(min(mine, count - 1u)) + 0.5) * width);
    const float below = running_sum(h), all = sum_of(h);
    share_of[mine] = width * (h + kSpread / float(count)) / (1.0 + kSpread);
    differences_in[mine] = width * luminance / scene_threshold(eye, luminance);
    gap_at[mine] = min(vec2(all - below + h, below) / kCounts, 1.0);
    barrier();

    Placing p;
    const float plain = log(high / low) / width;
    p.limit = kSteepest * plain;
    p.at = clamp((log(adaptation) - parameters.ln_low) / width, 0.0, last);
    p.want = adaptation * display_threshold(0.5 * high) / scene_threshold(eye, adaptation);
    p.there = low;
    const float highest = up(0.0, low, last, p.limit, 0.0, true, false);
    under_full = highest <= high;
    left_over = under_full ? log(high / highest) : 0.0;
    if (mine == 0u) shown_at[0] = low;
    if (!under_full) {
        const float lambda = exp(search(kOverLambda, log(plain), log(p.limit), p));
        if (mine == 0u) up(0.0, low, last, lambda, 0.0, false, true);
    } else {
        const float start = exp(search(kOverStart, log(low), log(high), p));
        p.there = up(0.0, start, p.at, p.limit, 0.0, true, false);
        const float above = search(kOverAbove, 0.0, 1.0, p), below_ = search(kOverBelow, 0.0, 1.0, p);
        if (mine == 0u) {
            up(p.at, p.there, last, p.limit, above, false, true);
            down(p.at, p.there, p.limit, below_, false, true);
            if (p.at == floor(p.at)) shown_at[uint(p.at)] = p.there;
        }
    }
    barrier();
    lowest = log(clamp(shown_at[0], low, high));
    return log(clamp(shown_at[min(mine, count - 1u) + 1u], low, high));
}
