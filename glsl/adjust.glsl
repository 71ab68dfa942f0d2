// Histogram adjustment after Ward Larson, Rushmeier and Piatko 1997: slopes of the curve (d ln Ld / d ln L) follow the
// histogram but stay under a ceiling, so that nothing becomes visible on the display that is invisible in the scene. The
// slopes min(lambda h, c) that fill the display range are the fixed point of Ward's trimming; lambda is found exactly. The
// ceilings depend on the curve, so this is iterated. For adapt.comp.

const uint kIterations = 24u;
const float kSpread = 1e-5;     // share of the votes spread over all bins, so that no part of the curve is flat
const float kSteepest = 1024.0; // lambda goes no higher than this times plain equalization: tiny shares fade in and out

shared float node[kMaxBins + 1u];   // ln of display luminance at the edges of the bins

struct Thresholds {
    float cone_sigma, rod_sigma;  // of the eye
};

float scene_threshold(Thresholds eye, float luminance) {
    if (parameters.ceiling == kCeilingLinear) return luminance;
    if (parameters.ceiling == kCeilingHuman) return human_threshold(luminance, parameters.cone_break, parameters.rod_break);
    if (parameters.ceiling == kCeilingCones) return cone_threshold(luminance, parameters.cone_break);
    const float cones = mal_adapted_threshold(parameters.cones, luminance, eye.cone_sigma);
    const float rods = mal_adapted_threshold(parameters.rods, luminance, eye.rod_sigma);
    return parameters.use_rods != 0u ? min(cones, rods) : cones;
}

float display_threshold(float luminance) {
    if (parameters.ceiling == kCeilingLinear) return luminance;
    if (parameters.ceiling == kCeilingHuman) return human_threshold(luminance, parameters.cone_break, parameters.rod_break);
    return cone_threshold(luminance, parameters.cone_break);
}

// Slopes min(lambda h, c) that add up to `wanted`; `under_full` if lambda ends at its limit before. More and more bins reach
// their ceilings while lambda grows; a round that finds no more of them is the last.
float water_filling(float h, float c, float wanted, float limit, out bool under_full) {
    bool at_ceiling = false;
    float lambda = 0.0, open_before = -1.0;
    for (uint round = 0u; round <= parameters.bins; ++round) {
        const vec2 sums = sum_of(at_ceiling ? vec2(c, 0.0) : vec2(0.0, h));  // what is spent, and who shares the rest
        lambda = sums.y > 0.0 ? min((wanted - sums.x) / sums.y, limit) : limit;
        if (sums.y == open_before || lambda >= limit) break;
        open_before = sums.y;
        at_ceiling = at_ceiling || lambda * h > c;
    }
    under_full = lambda >= limit;
    return min(lambda * h, c);
}

// Leaves the curve in node[]. `h`: share of the votes of this invocation's bin. `placed`: ln of the luminance that is shown
// where its visibility is that of the scene, if the display's range is not filled. Returns what of the range is left over.
float adjust(float h, Thresholds eye, float placed, out bool under_full) {
    const uint bin = gl_LocalInvocationIndex;
    const float ln_low = log(parameters.display_low), range = log(parameters.display_high) - ln_low;
    const float width = 1.0 / parameters.bins_per_ln, wanted = range * parameters.bins_per_ln;
    const float luminance = exp(parameters.ln_low + (float(min(bin, parameters.bins - 1u)) + 0.5) * width);
    const float scene_contrast = scene_threshold(eye, luminance) / luminance;
    const float placed_bin = clamp((placed - parameters.ln_low) * parameters.bins_per_ln, 0.0, float(parameters.bins));
    const uint under = uint(min(placed_bin, float(parameters.bins) - 1.0));
    // On a display half as bright as its white (Ferwerda et al. 1996).
    const float matched = placed + log(display_threshold(0.5 * parameters.display_high)) - log(scene_threshold(eye, exp(placed)));

    float mine = ln_low + running_sum(range * h);  // node above this bin: plain equalization
    if (bin == 0u) node[0] = ln_low;
    node[bin + 1u] = mine;
    float left_over = 0.0;
    for (uint iteration = 0u; iteration < kIterations; ++iteration) {
        barrier();
        const float shown = exp(0.5 * (node[bin] + node[bin + 1u]));
        const float lowest = node[0];
        const float c = display_threshold(shown) / shown / scene_contrast;
        const float slope = water_filling(h, c, wanted, kSteepest * wanted, under_full);
        const float above = running_sum(slope * width);
        left_over = under_full ? max(range - scratch[kMaxBins - 1u].x, 0.0) : 0.0;
        const float below = under > 0u ? scratch[under - 1u].x : 0.0;
        const float at_placed = below + (placed_bin - float(under)) * (scratch[under].x - below);
        const float offset = clamp(matched - ln_low - at_placed, 0.0, left_over);
        mine = 0.5 * (mine + ln_low + offset + above);
        barrier();
        if (bin == 0u) node[0] = 0.5 * (lowest + ln_low + offset);
        node[bin + 1u] = mine;
    }
    barrier();
    return left_over;
}
