#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// The illuminance that patches lit by moving lamps give surfaces, RGB lx; of the light between surfaces nothing is hidden yet: a = 1.

#include "normal.glsl"
#include "texels.glsl"
#include "shared/moving_light.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kRows = 1u;  // pixels of a column that an invocation does

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
layout(binding = 1, rgba16f) writeonly uniform image2D moving_light_image;
TEXELS(2, vec4, patches);
layout(push_constant, scalar) uniform Push { PatchesPush push; };

void main() {
    const uvec2 first = gl_GlobalInvocationID.xy * uvec2(1u, kRows);
    vec3 positions[kRows], normals[kRows], light[kRows];
    for (uint r = 0u; r < (push.patches > 0u ? kRows : 0u); ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        const vec4 surface = imageLoad(surface_image, ivec2(pixel));
        const bool drawn = surface.z > 0.0;
        positions[r] = vec3(push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset, -1.0) * (drawn ? surface.z : 1.0);
        normals[r] = drawn ? decode_normal(surface.xy) : vec3(0.0);  // the sky gets nothing
    }
    for (uint r = 0u; r < kRows; ++r) light[r] = vec3(0.0);
    for (uint k = 0u; k < push.patches; ++k) {
        const int texel = int(k * kPatchTexels);
        const vec4 at = texel_at(patches, texel), facing = texel_at(patches, texel + 1), intensity = texel_at(patches, texel + 2);
        for (uint r = 0u; r < kRows; ++r) {
            const vec3 to = at.xyz - positions[r];
            const float distance2 = dot(to, to), cosines = max(dot(normals[r], to), 0.0) * max(-dot(facing.xyz, to), 0.0);
            light[r] += intensity.rgb * (cosines / (max(distance2, 1e-12) * (distance2 + at.w * at.w)));
        }
    }
    for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        if (all(lessThan(pixel, push.size))) imageStore(moving_light_image, ivec2(pixel), vec4(min(light[r], vec3(65504.0)), 1.0));
    }
}
