#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_vote : require

// What moves and is near a surface: rgb, the illuminance that patches lit by moving lamps give it, lx; a, the part of the light between
// surfaces that bodies do not hide.

#include "normal.glsl"
#include "shared/moving_light.h"
#include "shared/photometry.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kRows = 1u;  // pixels of a column that an invocation does

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
layout(binding = 1, rgba16f) writeonly uniform image2D moving_light_image;
layout(binding = 2) uniform samplerBuffer things;
layout(binding = 3) uniform usamplerBuffer volumes;
layout(push_constant, scalar) uniform Push { MovingLightPush push; };

// Of `count` things of `texels` each, the last of which has their pixels: those that any of the column's pixels here is in.
uint near(uint first, uint count, uint texels, vec2 column, float rows) {
    uint found = 0u;
    for (uint k = 0u; k < count; ++k) {
        const vec4 covers = texelFetch(things, int(first + (k + 1u) * texels - 1u));
        const bool here = column.x >= covers.x && column.x < covers.z && column.y + rows > covers.y && column.y < covers.w;
        found |= subgroupAny(here) ? 1u << k : 0u;
    }
    return found;
}

// What the body number k hides.
float hidden_by(uint k, vec3 position, vec3 n) {
    const int first = int(k * kBodyTexels);
    const vec4 x = texelFetch(things, first), y = texelFetch(things, first + 1), z = texelFetch(things, first + 2);
    const uvec4 volume = uvec4(texelFetch(things, first + 3));
    const vec3 normal = normalize(vec3(dot(x.xyz, n), dot(y.xyz, n), dot(z.xyz, n)));
    const vec3 place = vec3(dot(x.xyz, position) + x.w, dot(y.xyz, position) + y.w, dot(z.xyz, position) + z.w) + normal;
    const bool within = all(greaterThanEqual(place, vec3(0.0))) && all(lessThan(place, vec3(volume.xyz - 1u)));
    float sum = 0.0;
    const bool any_within = subgroupAny(within);
    for (uint i = 0u; i < (any_within ? 1u : 0u); ++i) {
        const uvec3 corner = uvec3(within ? place : vec3(0.0));
        const vec3 share = place - vec3(corner), parts = normal * normal;
        const bvec3 back = lessThan(normal, vec3(0.0));
        [[unroll]] for (uint c = 0u; c < 8u; ++c) {
            const uvec3 offset = uvec3(c & 1u, c >> 1u & 1u, c >> 2u), at = corner + offset;
            const uvec2 hidden = texelFetch(volumes, int(volume.w + (at.z * volume.y + at.y) * volume.x + at.x)).xy;
            const vec3 linear = mix(1.0 - share, share, vec3(offset));
            const vec3 sides = vec3(hidden.x >> (back.x ? 8u : 0u) & 0xffu, hidden.x >> (back.y ? 24u : 16u) & 0xffu,
                                    hidden.y >> (back.z ? 8u : 0u) & 0xffu);
            sum += linear.x * linear.y * linear.z * dot(parts, sides);
        }
    }
    return within ? sum * (1.0 / 255.0) : 0.0;
}

// lx of the patch number k.
vec3 light_of(uint k, vec3 position, vec3 n) {
    const int first = int(push.bodies * kBodyTexels + k * kPatchTexels);
    const vec4 at = texelFetch(things, first), facing = texelFetch(things, first + 1), intensity = texelFetch(things, first + 2);
    const vec3 to = at.xyz - position;
    const float distance2 = dot(to, to), cosines = max(dot(n, to), 0.0) * max(-dot(facing.xyz, to), 0.0);
    return intensity.rgb * (cosines / (max(distance2, 1e-12) * (distance2 + at.w * at.w)));
}

void main() {
    const uvec2 first = gl_GlobalInvocationID.xy * uvec2(1u, kRows);
    const vec2 column = vec2(first) + 0.5;
    const uint bodies = near(0u, push.bodies, kBodyTexels, column, float(kRows));
    const uint patches = near(push.bodies * kBodyTexels, push.patches, kPatchTexels, column, float(kRows));
    for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        const bool inside = all(lessThan(pixel, push.size));
        const vec4 surface = imageLoad(surface_image, ivec2(pixel));
        const bool drawn = inside && surface.z > 0.0;
        const vec3 position = vec3(push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset, -1.0) * (drawn ? surface.z : 1.0);
        const vec3 n = decode_normal(drawn ? surface.xy : vec2(0.0));
        float open = 1.0;
        for (uint left = bodies; left != 0u; left &= left - 1u) open *= 1.0 - hidden_by(uint(findLSB(left)), position, n);
        vec3 light = vec3(0.0);
        for (uint left = patches; left != 0u; left &= left - 1u) light += light_of(uint(findLSB(left)), position, n);
        if (inside) imageStore(moving_light_image, ivec2(pixel), drawn ? vec4(min(light, vec3(65504.0)), open) : vec4(0.0, 0.0, 0.0, 1.0));
    }
}
