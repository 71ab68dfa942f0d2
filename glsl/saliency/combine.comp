#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Adds up promoted maps: those of the pairs of levels to intensity, colour and four orientations; orientations to one; and the
// conspicuities of intensity, colour and orientation to saliency, their mean.

#include "shared/saliency.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kAdds = kAddPairs;

layout(binding = 0, rgba32f) readonly uniform image2D maps;
layout(binding = 1, rgba32f) readonly uniform image2D factors;
layout(binding = 2, rgba32f) writeonly uniform image2D sums;
layout(push_constant, scalar) uniform Push { SaliencyMapsPush push; };

vec4 value_at(uvec2 at, uint map) { return imageLoad(maps, ivec2(at + uvec2(map % push.columns, map / push.columns) * push.size)); }
vec4 promoted(uvec2 at, uint map) { return imageLoad(factors, ivec2(map, 0)) * value_at(at, map); }

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.size))) return;
    if (kAdds == kAddPairs) {
        vec4 intensity = vec4(0.0), colours = vec4(0.0), oriented = vec4(0.0);
        for (uint map = 0u; map < push.columns; ++map) {
            intensity += promoted(at, map);
            colours += promoted(at, map + push.columns);
            oriented += promoted(at, map + 2u * push.columns);
        }
        imageStore(sums, ivec2(at), vec4(intensity.x, dot(colours, vec4(1.0)), 0.0, 0.0));
        imageStore(sums, ivec2(at.x, at.y + push.size.y), oriented);
    } else if (kAdds == kAddOrientations) {
        imageStore(sums, ivec2(at), vec4(value_at(at, 0u).xy, dot(promoted(at, 1u), vec4(1.0)), 0.0));
    } else {
        const vec3 conspicuity = promoted(at, 0u).xyz;
        imageStore(sums, ivec2(at), vec4(dot(conspicuity, vec3(1.0)) / 3.0, conspicuity));
    }
}
