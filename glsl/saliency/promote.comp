#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// The factor that promotes maps in which few places stand out (the operator N of Itti, Koch and Niebur 1998): a map is stretched to
// a greatest value M and multiplied by (M - m)^2, where m is the mean of its other local maxima. A local maximum is greater than its
// neighbours in rows above and to its left and not less than the others, so that even peaks count once. A workgroup for each four maps.

#include "shared/saliency.h"

layout(local_size_x = 64) in;

layout(binding = 0, rgba32f) readonly uniform image2D maps;
layout(binding = 1, rgba32f) writeonly uniform image2D factors;
layout(push_constant, scalar) uniform Push { SaliencyMapsPush push; };

shared vec4 told[64], told_counts[64];

vec4 value_at(ivec2 at) { return imageLoad(maps, at + ivec2(gl_WorkGroupID.x % push.columns, gl_WorkGroupID.x / push.columns) * ivec2(push.size)); }

void main() {
    const uint mine = gl_LocalInvocationIndex, texels = push.size.x * push.size.y;
    vec4 most = vec4(0.0);
    [[dont_unroll]] for (uint i = mine; i < texels; i += 64u) most = max(most, value_at(ivec2(i % push.size.x, i / push.size.x)));
    told[mine] = most;
    for (uint half_ = 32u; half_ > 0u; half_ /= 2u) {
        barrier();
        if (mine < half_) told[mine] = max(told[mine], told[mine + half_]);
    }
    barrier();
    most = told[0];
    barrier();

    vec4 sum = vec4(0.0), count = vec4(0.0);
    [[dont_unroll]] for (uint i = mine; i < texels; i += 64u) {
        const ivec2 at = ivec2(i % push.size.x, i / push.size.x);
        const vec4 own = value_at(at);
        vec4 peak = vec4(greaterThan(own, vec4(0.0))) * vec4(greaterThanEqual(own, kLeastPeak * most));
        [[unroll]] for (int k = 0; k < 9; ++k) {
            const ivec2 near = at + ivec2(k % 3, k / 3) - 1;
            if (k == 4) continue;
            const bool inside = all(greaterThanEqual(near, ivec2(0))) && all(lessThan(near, ivec2(push.size)));
            const vec4 other = value_at(clamp(near, ivec2(0), ivec2(push.size) - 1));
            peak *= inside ? (k < 4 ? vec4(greaterThan(own, other)) : vec4(greaterThanEqual(own, other))) : vec4(1.0);
        }
        sum += peak * own;
        count += peak;
    }
    told[mine] = sum, told_counts[mine] = count;
    for (uint half_ = 32u; half_ > 0u; half_ /= 2u) {
        barrier();
        if (mine < half_) told[mine] += told[mine + half_], told_counts[mine] += told_counts[mine + half_];
    }
    barrier();
    if (mine != 0u) return;
    const vec4 others = max(told_counts[0] - 1.0, 0.0), mean = max(told[0] - most, 0.0) / max(others, 1.0);
    const vec4 stretch = 1.0 / max(most, kLeastContrast), above = stretch * (most - mean);
    imageStore(factors, ivec2(gl_WorkGroupID.x, 0), stretch * above * above);
}
