// Histogram adjustment (Ward Larson, Rushmeier and Piatko 1997) that is anchored at what the eye is adapted to. For adapt.comp.
//
// All is counted in just noticeable differences: of the scene, dL / T(L), as the eye in its state sees them; of the display,
// dR / viewer_step, as a viewer adapted to kViewerOfWhite sees them, R = L / (L + viewer_sigma). The curve goes through the anchor: what
// the eye is adapted to is as visible on the display as in the scene. Below it the curve depends on the eye alone. Above it a
// step has min(n, b base + l votes): n differences of the scene are the ceiling, `base` fills the rest of the display without any votes,
// and votes add contrast where they are. l is fixed, so that a share of the votes moves a grey by no more than that share of all codes; b
// fills the display.

const float kClaim = 1.0;      // lightness, relative, that all votes together may claim (l)
const float kLeastBase = 0.5;  // part of the base curve that votes leave (the least b)
const float kLightness = 1.0 / 2.2;  // lightness is relative luminance to this power: proportional to codes of common displays
const float kGauss = 0.2886751346;     // 1 / (2 sqrt 3)
const uint kHalvings = 30u;    // of an interval of ln luminance
const uint kRounds = 3u;       // of the search; each tries kMaxBins candidates, and the next is between two of them

shared float ceiling_of[kMaxBins];  // n, above the anchor
shared float base_of[kMaxBins];
shared float votes_of[kMaxBins];    // l times the votes, in differences
shared uint best;
shared float share_of[kMaxBins];  // of the votes, bin by bin

// Of the eye; of rods in luminance, as the histogram is.
struct Thresholds {
    float cone_sigma, rod_sigma;
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

float viewer_response(float luminance) { return luminance / (luminance + parameters.viewer_sigma); }
float luminance_of_response(float response) { return parameters.viewer_sigma * response / (1.0 - response); }

// Differences between the display's darkest luminance and another one; with kCeilingLinear, ln of their ratio.
float differences_at(float luminance) {
    if (parameters.ceiling == kCeilingLinear) return log(luminance / parameters.display_low);
    return (viewer_response(luminance) - viewer_response(parameters.display_low)) / parameters.viewer_step;
}

// The luminance that many differences above the darkest, cd/m^2.
float luminance_at(float differences) {
    if (parameters.ceiling == kCeilingLinear) return parameters.display_low * exp(differences);
    return luminance_of_response(differences * parameters.viewer_step + viewer_response(parameters.display_low));
}

// d lightness / d differences.
float lightness_slope(float differences) {
    const float luminance = luminance_at(differences), range = parameters.display_high - parameters.display_low;
    const float reach = luminance + parameters.viewer_sigma;
    const float rise = parameters.ceiling == kCeilingLinear ? luminance : parameters.viewer_step * reach * (reach / parameters.viewer_sigma);
    return kLightness * pow(max((luminance - parameters.display_low) / range, 1e-6), kLightness - 1.0) * rise / range;
}

// `differences` from the anchor, of which there are `all`, with slope 1 at the anchor and `room` for all of them.
float compressed(float differences, float all, float room) {
    return room > 0.0 ? differences / (1.0 + (all > room ? differences * (1.0 / room - 1.0 / all) : 0.0)) : 0.0;
}

// The same seen from the other end: `climbed` of all differences from the darkest, which is 0, to the anchor, at `room`, at most `all`.
float climbed(float differences, float all, float room) {
    return room > 0.0 ? differences * (room / all) / (1.0 + (all - differences) * (1.0 / room - 1.0 / all)) : 0.0;
}

// The luminance to which cones of that half saturation are adapted: where their threshold is that of adapted ones, below half saturation.
float adapted_luminance(float sigma) {
    float low = log(kLuminanceFloor), high = max(log(sigma), low);
    for (uint i = 0u; i < kHalvings; ++i) {
        const float middle = 0.5 * (low + high), luminance = exp(middle);
        const float adapted = power_of_ten(cone_log_threshold(log10_of(luminance), parameters.cone_break)) * parameters.cones.factor;
        if (adapted > mal_adapted_threshold(parameters.cones, luminance, sigma)) high = middle;
        else low = middle;
    }
    return exp(low);
}

// Where the display shows what the eye is adapted to, in differences: L / T(L) is that of the scene, up to what the viewer is adapted to.
float anchor_of(Thresholds eye, float adapted) {
    const float threshold = parameters.ceiling == kCeilingLinear ? power_of_ten(cone_log_threshold(log10_of(adapted), parameters.cone_break)) : scene_threshold(eye, adapted);
    const float x = min(parameters.viewer_step * adapted / threshold, 0.25);  // R (1 - R) of the viewer
    const float response = x / (0.5 + sqrt(0.25 - x)) + viewer_response(parameters.display_low);
    const float most = differences_at(max(kViewerOfWhite * parameters.display_high, parameters.display_low));
    return response < 0.5 ? min(differences_at(luminance_of_response(response)), most) : most;
}

// Differences that the eye sees in a step of the curve whose middle is at `ln_middle` (Gauss's rule of two points).
float differences_in(Thresholds eye, float ln_middle, float width) {
    const float low = exp(ln_middle - kGauss * width), high = exp(ln_middle + kGauss * width);
    return 0.5 * width * (low / scene_threshold(eye, low) + high / scene_threshold(eye, high));
}

// Shares of votes and base, at a place x from 0 (none, and the least base) to 1 (all that ceilings allow).
struct Mix {
    float votes, base;
};

Mix mix_at(float x, float most_base) {
    return Mix(min(2.0 * x, 1.0), kLeastBase * pow(most_base / kLeastBase, max(2.0 * x - 1.0, 0.0)));
}

float rise(uint i, Mix m) { return min(ceiling_of[i], m.base * base_of[i] + m.votes * votes_of[i]); }

// The largest mix whose steps have `room`.
Mix fill(float room, float most_base) {
    const uint mine = gl_LocalInvocationIndex;
    const float last = float(kMaxBins - 1u);
    float a = 0.0, b = 1.0;
    for (uint round = 0u; round < kRounds; ++round) {
        if (mine == 0u) best = 0u;
        barrier();
        const Mix tried = mix_at(mix(a, b, float(mine) / last), most_base);
        float sum = 0.0;
        for (uint i = 0u; i < steps(); ++i) sum += rise(i, tried);
        if (sum <= room) atomicMax(best, mine);
        barrier();
        const float from = float(best);
        const float low = mix(a, b, from / last), high = mix(a, b, min(from + 1.0, last) / last);
        a = low, b = high;
        barrier();
    }
    return mix_at(a, most_base);
}

// ln Ld at the upper edge of this invocation's step; `lowest`: at the lower edge of the first. `h`: share of the votes.
// `under_full`: the ceilings do not fill the display. `left_over`: ln of the part of its range above the curve.
float adjust(float h, Thresholds eye, out float lowest, out bool under_full, out float left_over) {
    const uint mine = gl_LocalInvocationIndex, count = steps();
    const float low = parameters.display_low, high = parameters.display_high;
    const float width = 1.0 / (parameters.bins_per_ln * float(parameters.steps_per_bin));
    const float seen = mine < count ? differences_in(eye, parameters.ln_low + (float(mine) + 0.5) * width, width) : 0.0;
    // Between no light and the first step, in which thresholds are constant.
    const float first = exp(parameters.ln_low), darker = parameters.ceiling == kCeilingLinear ? 0.0 : first / scene_threshold(eye, first);
    const float adapted = adapted_luminance(eye.cone_sigma);
    const float at = clamp((log(adapted) - parameters.ln_low) / width, 0.0, float(count));  // of the anchor, in steps
    const float part_above = clamp(float(mine) + 1.0 - at, 0.0, 1.0);
    const float above = part_above * seen, to_above = running_sum(above), all_above = sum_of(above);
    const float below = seen - above, to_below = running_sum(below), all_below = sum_of(below) + darker;
    // No more differences than the eye sees: no light stays black.
    const float anchor = min(anchor_of(eye, adapted), all_below), room = differences_at(high) - anchor;
    const float base_from = compressed(max(to_above - above, 0.0), all_above, room), base_to = compressed(to_above, all_above, room);
    ceiling_of[mine] = above;
    base_of[mine] = base_to - base_from;
    // The steepest place of lightness from here on is here or at white.
    votes_of[mine] = kClaim * part_above * h / max(lightness_slope(anchor + 0.5 * (base_from + base_to)), lightness_slope(anchor + room));
    barrier();

    under_full = all_above <= room;
    const Mix m = fill(room, max(all_above * all_above / (room * room), 1.0));
    const float from_anchor = running_sum(mine < count ? rise(mine, m) : 0.0), all_risen = sum_of(mine < count ? rise(mine, m) : 0.0);
    left_over = under_full ? log(high / luminance_at(min(anchor + all_risen, anchor + room))) : 0.0;
    lowest = log(clamp(luminance_at(climbed(darker, all_below, anchor)), low, high));
    const float here = part_above > 0.0 ? min(anchor + from_anchor, anchor + room) : climbed(darker + to_below, all_below, anchor);
    return log(clamp(luminance_at(here), low, high));
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

// The curve of a frame whose eye is in its present state.
void adjusted_curve(Frame frame) {
    const float h = per_step(frame.share);
    float lowest = log(parameters.display_low), here = lowest;
    if (!frame.empty) here = adjust(h, Thresholds(frame.cone_sigma, frame.rod_sigma / parameters.scotopic), lowest, made.under_full, made.left_over);
    write_smoothed_nodes(frame, here, lowest);
}
