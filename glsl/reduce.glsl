// Sums over a workgroup of kMaxBins invocations. Every invocation must call them. For adapt.comp.

shared vec2 scratch[kMaxBins];

vec2 sum_of(vec2 value) {
    const uint mine = gl_LocalInvocationIndex;
    barrier();
    scratch[mine] = value;
    for (uint half_ = kMaxBins / 2u; half_ > 0u; half_ /= 2u) {
        barrier();
        if (mine < half_) scratch[mine] += scratch[mine + half_];
    }
    barrier();
    return scratch[0];
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
