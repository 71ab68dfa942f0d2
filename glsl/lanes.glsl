// What the eight invocations of a workgroup tell each other; every one calls, all from the same place. A CPU device takes
// them side by side (kLockstep), where votes and sums of a subgroup are single instructions. Elsewhere they may part at
// loops and branches, and Vulkan does not say where they meet again: there they wait for one another. Needs the
// extensions for votes and arithmetic of subgroups.

const uint kLanes = 8u;
shared uint lane_words[kLanes];

// Afterwards each sees what the others wrote to shared memory.
void lanes_wait() {
    if (kLockstep != 0u) subgroupBarrier();
    else barrier();
}

void tell_lanes(uint word) {
    lane_words[gl_LocalInvocationID.x] = word;
    barrier();
}

// The sum of what the first `lanes` tell.
uint sum_of_lanes(uint value, uint lanes) {
    tell_lanes(value);
    uint sum = 0u;
    for (uint k = 0u; k < lanes; ++k) sum += lane_words[k];
    barrier();
    return sum;
}

uint lanes_add(uint value) {
    if (kLockstep != 0u) return subgroupAdd(value);
    return sum_of_lanes(value, kLanes);
}

// The sum over those before this one.
uint lanes_add_before(uint value) {
    if (kLockstep != 0u) return subgroupExclusiveAdd(value);
    return sum_of_lanes(value, gl_LocalInvocationID.x);
}

uint lanes_max(uint value) {
    if (kLockstep != 0u) return subgroupMax(value);
    tell_lanes(value);
    uint most = 0u;
    for (uint k = 0u; k < kLanes; ++k) most = max(most, lane_words[k]);
    barrier();
    return most;
}

uint lanes_or(uint value) {
    if (kLockstep != 0u) return subgroupOr(value);
    tell_lanes(value);
    uint any = 0u;
    for (uint k = 0u; k < kLanes; ++k) any |= lane_words[k];
    barrier();
    return any;
}

bool lanes_any(bool value) {
    if (kLockstep != 0u) return subgroupAny(value);
    return lanes_or(value ? 1u : 0u) != 0u;
}

// A bit for each that tells true.
uint lanes_mask(bool value) { return lanes_or(value ? 1u << gl_LocalInvocationID.x : 0u); }

float lanes_add(float value) {
    if (kLockstep != 0u) return subgroupAdd(value);
    tell_lanes(floatBitsToUint(value));
    float sum = 0.0;
    for (uint k = 0u; k < kLanes; ++k) sum += uintBitsToFloat(lane_words[k]);
    barrier();
    return sum;
}

float lanes_max(float value) {
    if (kLockstep != 0u) return subgroupMax(value);
    tell_lanes(floatBitsToUint(value));
    float most = uintBitsToFloat(lane_words[0]);
    for (uint k = 1u; k < kLanes; ++k) most = max(most, uintBitsToFloat(lane_words[k]));
    barrier();
    return most;
}
