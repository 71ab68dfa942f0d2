#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Changes of the light between surfaces by things that move: RGB, the illuminance that patches lit by moving lamps give, lx; A, the
// part of the rest that bodies do not hide.

#include "normal.glsl"
#include "texels.glsl"
#include "shared/moving_light.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kRows = 1u;  // pixels of a column that an invocation does

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
layout(binding = 1, rgba16f) writeonly uniform image2D moving_light_image;
TEXELS(2, vec4, patches);
TEXELS(3, uvec4, bodies);
TEXELS(4, uvec4, volumes);
layout(push_constant, scalar) uniform Push { MovingLightPush push; };

// Light that a body hides on a surface, in parts of kMostHidden; `place`: before the surface, in steps from the first place.
float hidden_at(uvec3 places, uint first_place, vec3 place, vec3 normal) {
    const uvec3 corner = uvec3(place);
    const vec3 share = place - vec3(corner), parts = normal * normal;
    const uvec3 shift = kHiddenBits * (uvec3(0u, 2u, 4u) + mix(uvec3(0u), uvec3(1u), lessThan(normal, vec3(0.0))));
    const vec2 x = vec2(1.0 - share.x, share.x), y = vec2(1.0 - share.y, share.y), z = vec2(1.0 - share.z, share.z);
    const uint at = first_place + (corner.z * places.y + corner.y) * places.x + corner.x;
    vec3 sum = vec3(0.0);  // of the sides
    [[unroll]] for (uint layer = 0u; layer < 2u; ++layer) {
        const uvec4 hidden = texel_at(volumes, int(at + layer * places.x * places.y));
        const vec4 linear = z[layer] * vec4(x * y.x, x * y.y);
        [[unroll]] for (uint c = 0u; c < 4u; ++c) sum += linear[c] * vec3(uvec3(hidden[c]) >> shift & kMostHidden);
    }
    return dot(parts, sum);
}

void main() {
    const uvec2 first = gl_GlobalInvocationID.xy * uvec2(1u, kRows);
    vec3 positions[kRows], normals[kRows];
    vec4 light[kRows];
    float nearest = 3e38, farthest = 0.0;  // m
    [[unroll]] for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        const vec4 surface = imageLoad(surface_image, ivec2(pixel));
        const bool drawn = surface.z > 0.0;
        positions[r] = vec3(push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset, -1.0) * (drawn ? surface.z : 1.0);
        normals[r] = drawn ? decode_normal(surface.xy) : vec3(0.0);  // the sky gets nothing
        light[r] = vec4(0.0, 0.0, 0.0, 1.0);
        nearest = min(nearest, drawn ? surface.z : nearest), farthest = max(farthest, drawn ? surface.z : 0.0);
    }
    for (uint k = 0u; k < push.patches; ++k) {
        const int texel = int(k * kPatchTexels);
        const vec4 at = texel_at(patches, texel), facing = texel_at(patches, texel + 1), intensity = texel_at(patches, texel + 2);
        [[unroll]] for (uint r = 0u; r < kRows; ++r) {
            const vec3 to = at.xyz - positions[r];
            const float distance2 = dot(to, to), cosines = max(dot(normals[r], to), 0.0) * max(-dot(facing.xyz, to), 0.0);
            light[r].rgb += intensity.rgb * (cosines / (max(distance2, 1e-12) * (distance2 + at.w * at.w)));
        }
    }
    // Bodies that the pixels of this column may be beside, a bit each.
    uint left = 0u;
    for (uint k = 0u; k < push.bodies; ++k) {
        const uvec4 pixels = texel_at(bodies, int(k * kBodyTexels));
        const vec2 depths = uintBitsToFloat(texel_at(bodies, int(k * kBodyTexels) + 1).xy);
        const bool touches = first.x >= pixels.x && first.x < pixels.z && first.y + kRows > pixels.y && first.y < pixels.w;
        left |= touches && nearest <= depths.y && farthest >= depths.x ? 1u << k : 0u;
    }
    // A CPU device goes through what a branch leaves out, but leaves a loop that asks at its end.
    do {
        if (left != 0u) {
            const int texel = findLSB(left) * int(kBodyTexels);
            const uvec4 volume = texel_at(bodies, texel + 2);
            const vec4 x = uintBitsToFloat(texel_at(bodies, texel + 3)), y = uintBitsToFloat(texel_at(bodies, texel + 4)),
                       z = uintBitsToFloat(texel_at(bodies, texel + 5));
            [[unroll]] for (uint r = 0u; r < kRows; ++r) {
                const vec3 p = positions[r], n = normals[r];
                const vec3 normal = normalize(vec3(dot(x.xyz, n), dot(y.xyz, n), dot(z.xyz, n)));
                const vec3 place = vec3(dot(x.xyz, p) + x.w, dot(y.xyz, p) + y.w, dot(z.xyz, p) + z.w) + normal;
                const bool within = n != vec3(0.0) && all(greaterThanEqual(place, vec3(0.0))) && all(lessThan(place, vec3(volume.xyz - 1u)));
                const float hidden = hidden_at(volume.xyz, volume.w, within ? place : vec3(0.0), normal);
                light[r].a *= within ? 1.0 - hidden * (1.0 / float(kMostHidden)) : 1.0;
            }
        }
        left &= left - 1u;
    } while (left != 0u);
    [[unroll]] for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        if (all(lessThan(pixel, push.size)))
            imageStore(moving_light_image, ivec2(pixel), vec4(min(light[r].rgb, vec3(65504.0)), light[r].a));
    }
}
