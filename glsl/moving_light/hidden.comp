#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_vote : require

// One body that moves: what it leaves of the light between surfaces, on the pixels that it may cover.

#include "normal.glsl"
#include "texels.glsl"
#include "shared/moving_light.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kRows = 1u;  // pixels of a column that an invocation does

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
layout(binding = 1, rgba16f) uniform image2D moving_light_image;
TEXELS(2, uint, volumes);
layout(push_constant, scalar) uniform Push { HiddenPush push; };

// Of the light on a surface, in parts of kMostHidden; `place`: before it, in steps from the first place.
float hidden_at(vec3 place, vec3 normal) {
    const uvec3 corner = uvec3(place);
    const vec3 share = place - vec3(corner), parts = normal * normal;
    const uvec3 side = uvec3(0u, 2u, 4u) + mix(uvec3(0u), uvec3(1u), lessThan(normal, vec3(0.0))), shift = kHiddenBits * side;
    float sum = 0.0;
    [[unroll]] for (uint c = 0u; c < 8u; ++c) {
        const uvec3 offset = uvec3(c & 1u, c >> 1u & 1u, c >> 2u), at = corner + offset;
        const uint hidden = texel_at(volumes, int(push.volume.w + (at.z * push.volume.y + at.y) * push.volume.x + at.x)).x;
        const vec3 linear = mix(1.0 - share, share, vec3(offset));
        sum += linear.x * linear.y * linear.z * dot(parts, vec3(uvec3(hidden) >> shift & kMostHidden));
    }
    return sum;
}

void main() {
    const uvec2 first = push.first_pixel + gl_GlobalInvocationID.xy * uvec2(1u, kRows);
    for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        const vec4 surface = imageLoad(surface_image, ivec2(pixel));
        const bool near = all(lessThan(pixel, push.end_pixel)) && surface.z >= push.depths.x && surface.z <= push.depths.y && surface.z > 0.0;
        // Loops of one turn are there for CPU devices, which leave them when no lane takes them.
        const bool any_near = subgroupAny(near);
        for (uint i = 0u; i < (any_near ? 1u : 0u); ++i) {
            const vec3 position = vec3(push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset, -1.0) * (near ? surface.z : 1.0);
            const vec3 n = decode_normal(near ? surface.xy : vec2(0.0));
            const vec3 normal = normalize(vec3(dot(push.x.xyz, n), dot(push.y.xyz, n), dot(push.z.xyz, n)));
            const vec3 place = vec3(dot(push.x.xyz, position) + push.x.w, dot(push.y.xyz, position) + push.y.w,
                                    dot(push.z.xyz, position) + push.z.w) + normal;
            const bool within = near && all(greaterThanEqual(place, vec3(0.0))) && all(lessThan(place, vec3(push.volume.xyz - 1u)));
            const bool any_within = subgroupAny(within);
            for (uint k = 0u; k < (any_within ? 1u : 0u); ++k) {
                const float open = 1.0 - hidden_at(within ? place : vec3(0.0), normal) * (1.0 / float(kMostHidden));
                const vec4 was = imageLoad(moving_light_image, ivec2(pixel));
                if (within) imageStore(moving_light_image, ivec2(pixel), vec4(was.rgb, was.a * open));
            }
        }
    }
}
