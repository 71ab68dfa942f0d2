// Sums over a workgroup of kMaxBins invocations. Every invocation must call them. For adapt.comp.

shared float scratch[kMaxBins];

float sum_of(float value) {
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
