#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Histogram of ln luminance over one level of the pyramid. A texel votes with the number of finite pixels under it, in
// integers, so the result does not depend on the order of the votes.

#include "shared/luminance.h"

layout(local_size_x = 64) in;

layout(binding = 0, rgba32f) readonly uniform image2D level_image;
layout(binding = 1, scalar) buffer Counts { Histogram histogram; };
layout(push_constant, scalar) uniform Push { HistogramPush push; };

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.level_size))) return;
    const vec4 statistics = imageLoad(level_image, ivec2(at));
    const uvec2 covered = min(push.image_size - (at << push.level), uvec2(1u << push.level));
    const uint finite = uint(statistics.g + 0.5);
    atomicAdd(histogram.non_finite, covered.x * covered.y - finite);
    if (finite == 0u) return;
    atomicAdd(histogram.finite, finite);
    const float position = statistics.r > 0.0 ? (log(statistics.r) - push.ln_low) * push.bins_per_ln : 0.0;
    atomicAdd(histogram.count[uint(clamp(position, 0.0, float(push.bins) - 1.0))], finite);
}
