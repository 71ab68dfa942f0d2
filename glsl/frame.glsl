// The statistics of a frame that operators read, and the results that they write, for adapt.comp and glsl/operators/.
// An operator begins as no table and no numbers: every node shows the display's darkest luminance.

// The same in every invocation, but for the share.
struct Frame {
    bool empty, first;           // no finite pixel; the first frame of this eye
    float log_average, mean, maximum;  // of luminance, cd/m^2
    float adaptation, scotopic;  // of the eye: cd/m^2, and scotopic cd/m^2
    float cones_see, rods_see;   // thresholds of adapted cones and rods, without the factors of the observer
    float cone_sigma, rod_sigma; // half saturation of the eye
    float share;                 // of the votes, of this invocation's bin
};

struct Made {
    vec4 block[kOperatorTexels];  // ToneCurve::block
    float ln_low, steps_per_ln, steps;
    bool under_full;
    float left_over;
    bool has_nodes;  // the operator wrote them
    bool smoothed;   // and EyeState::node
    PattanaikState pattanaik;
    vec3 chroma;
};
Made made;

shared float percentile[2];

uint steps() { return parameters.bins * parameters.steps_per_bin; }

void begin_frame() {
    for (uint i = 0u; i < kOperatorTexels; ++i) made.block[i] = vec4(0.0);
    made.ln_low = parameters.ln_low;
    made.steps_per_ln = parameters.bins_per_ln * float(parameters.steps_per_bin);
    made.steps = float(steps());
    made.under_full = made.has_nodes = made.smoothed = false;
    made.left_over = 0.0;
    made.pattanaik = previous.pattanaik;
    made.chroma = previous.chroma;
}

// This invocation's node, and of invocation 0 the lowest one: ln of display luminance.
void write_nodes(float here, float lowest) {
    const uint mine = gl_LocalInvocationIndex;
    if (mine < steps()) curve.node[mine + 1u] = vec4(here, 0.0, 0.0, 0.0);
    if (mine == 0u) curve.node[0] = vec4(lowest, 0.0, 0.0, 0.0);
    for (uint i = steps() + 1u + mine; i <= kMaxNodes; i += kMaxBins) curve.node[i] = vec4(0.0);
    made.has_nodes = true;
}

const float kLeash = 0.25;  // ln of display luminance by which a curve that is smoothed over time lags behind at most

// A node of a curve over time: flicker is smoothed, another scene is not.
float follow(float from, float to, float kept) {
    return kept < 1.0 ? clamp(blend(from, to, kept), to - kLeash, to + kLeash) : from;
}

// The same, with nodes that follow over time; an empty frame, and a pause, leave them as they were.
void write_smoothed_nodes(Frame frame, float here, float lowest) {
    const uint mine = gl_LocalInvocationIndex;
    const float smoothing = parameters.smoothing_seconds;
    const float kept = frame.empty ? 1.0 : smoothing > 0.0 ? exp(-parameters.seconds / smoothing) : 0.0;
    const bool same_steps = previous.steps == made.steps && previous.ln_low == parameters.ln_low &&
                            previous.steps_per_ln == made.steps_per_ln;
    if (!frame.first && same_steps) {
        here = follow(previous.node[mine + 1u], here, kept);
        lowest = follow(previous.node[0], lowest, kept);
    }
    write_nodes(here, lowest);
    current.node[mine + 1u] = mine < steps() ? here : 0.0;
    if (mine == 0u) current.node[0] = lowest;
    made.smoothed = true;
}

const float kTableLow = -9.210340372, kTableHigh = 18.420680744;  // ln of 1e-4 and 1e8 cd/m^2

// Luminance of node `index` of a table of kMaxNodes + 1 that does not depend on the histogram.
float table_luminance(uint index) { return exp(mix(kTableLow, kTableHigh, float(index) / float(kMaxNodes))); }

// Says that the operator writes such a table: every invocation its nodes, from its index on in steps of kMaxBins.
void begin_table() {
    made.ln_low = kTableLow, made.steps = float(kMaxNodes);
    made.steps_per_ln = float(kMaxNodes) / (kTableHigh - kTableLow);
    made.has_nodes = true;
}

// A node of such a table, of displayed luminance relative to the display's range.
vec4 node_of(float relative) {
    const float range = parameters.display_high - parameters.display_low;
    return vec4(log(parameters.display_low + range * clamp(relative, 0.0, 1.0)), 0.0, 0.0, 0.0);
}

// ln of the luminances below which 1 and 99 % of the votes are, into `percentile`. Every invocation must call it.
void find_percentiles(Frame frame) {
    const float share = frame.share, voters = max(sum_of(share), 1e-30);
    const uint bin = gl_LocalInvocationIndex;
    if (bin < 2u) percentile[bin] = parameters.ln_low;
    const float above = running_sum(share) / voters, below = above - share / voters;
    for (uint i = 0u; i < 2u; ++i) {
        const float part = i == 0u ? 0.01 : 0.99;
        if (below < part && above >= part)
            percentile[i] = parameters.ln_low + (float(bin) + (part - below) * voters / share) / parameters.bins_per_ln;
    }
    barrier();
}

void end_nodes() {
    const uint mine = gl_LocalInvocationIndex;
    const float ln_display_low = log(parameters.display_low);
    if (!made.has_nodes) write_nodes(ln_display_low, ln_display_low);
    if (made.smoothed) return;
    current.node[mine + 1u] = 0.0;
    if (mine == 0u) current.node[0] = 0.0;
}
