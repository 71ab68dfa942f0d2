// Sums and extremes over a workgroup of kMaxBins invocations. Every invocation must call them. For adapt.comp.

shared vec2 scratch[kMaxBins];

float sum_of(float value) {
    const uint mine = gl_LocalInvocationIndex;
    barrier();
    scratch[mine].x = value;
    for (uint half_ = kMaxBins / 2u; half_ > 0u; half_ /= 2u) {
        barrier();
        if (mine < half_) scratch[mine].x += scratch[mine + half_].x;
    }
    barrier();
    return scratch[0].x;
}

// Sum over this invocation and those before it.
float running_sum(float value) {
    const uint mine = gl_LocalInvocationIndex;
    barrier();
    scratch[mine].x = value;
    for (uint step = 1u; step < kMaxBins; step *= 2u) {
        barrier();
        const float left = mine >= step ? scratch[mine - step].x : 0.0;
        barrier();
        scratch[mine].x += left;
    }
    barrier();
    return scratch[mine].x;
}

// Smallest and largest value of those invocations that count.
vec2 extremes_of(bool counts, float value) {
    const uint mine = gl_LocalInvocationIndex;
    barrier();
    scratch[mine] = counts ? vec2(value) : vec2(1e30, -1e30);
    for (uint half_ = kMaxBins / 2u; half_ > 0u; half_ /= 2u) {
        barrier();
        if (mine < half_) scratch[mine] = vec2(min(scratch[mine].x, scratch[mine + half_].x), max(scratch[mine].y, scratch[mine + half_].y));
    }
    barrier();
    return scratch[0];
}
