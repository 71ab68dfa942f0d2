#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require

// Histogram of ln luminance over one level of the pyramid. A texel votes for the finite pixels under it, in integers, so
// the result does not depend on the order of the votes. Neighbours often vote for the same bins: a column of them is
// added up before it votes.

#include "shared/luminance.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kRows = 1u;  // texels of a column that one invocation counts

layout(binding = 0, rgba32f) readonly uniform image2D level_image;
layout(binding = 1, scalar) buffer Counts { Histogram histogram; };
layout(push_constant, scalar) uniform Push { HistogramPush push; };

void vote_for(uint bin, uint lower, uint upper) {
    if (lower > 0u) atomicAdd(histogram.count[bin], lower);
    if (upper > 0u) atomicAdd(histogram.count[bin + 1u], upper);
}

void main() {
    const float last = float(push.bins) - 1.0;
    uint held = 0u, lower = 0u, upper = 0u;  // votes for the bins `held` and `held` + 1
    uint finite = 0u, non_finite = 0u, votes = 0u;
    for (uint row = 0u; row < kRows; ++row) {
        const uvec2 at = gl_GlobalInvocationID.xy * uvec2(1u, kRows) + uvec2(0u, row);
        if (any(greaterThanEqual(at, push.level_size))) continue;
        const vec4 statistics = imageLoad(level_image, ivec2(at));
        const uint pixels = uint(statistics.g + 0.5);
        const uvec2 covered = min(push.image_size - (at << push.level), uvec2(1u << push.level));
        finite += pixels;
        non_finite += covered.x * covered.y - pixels;
        if (pixels == 0u) continue;
        const float position = statistics.r > 0.0 ? (log(statistics.r) - push.ln_low) * push.bins_per_ln : 0.0;
        const float middle = clamp(position - 0.5, 0.0, last);  // 0: in the middle of bin 0
        const uint bin = push.split != 0u ? uint(middle) : uint(clamp(position, 0.0, last));
        const uint mine = (pixels * push.votes + ((1u << push.overlap) >> 1u)) >> push.overlap;
        const uint shared_ = push.split != 0u ? uint(fract(middle) * float(mine) + 0.5) : 0u;
        if (bin != held) {
            vote_for(held, lower, upper);
            held = bin;
            lower = 0u, upper = 0u;
        }
        lower += mine - shared_;
        upper += shared_;
        votes += mine;
    }
    vote_for(held, lower, upper);
    const uint all_votes = subgroupAdd(votes);
    if (subgroupElect()) atomicAdd(histogram.votes, all_votes);
    if (push.census == 0u) return;
    atomicAdd(histogram.finite, finite);
    atomicAdd(histogram.non_finite, non_finite);
}
