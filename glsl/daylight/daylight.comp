#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Light from everywhere, E on any surface in the open: adds E rho lambert. Inside a tunnel it comes through the two ends only, rectangles
// of luminance E / pi: their form factor is Lambert's sum over the edges of what lies above the horizon of the surface.

#include "normal.glsl"
#include "sheen.glsl"
#include "texels.glsl"
#include "shared/daylight.h"
#include "shared/photometry.h"
#include "shared/shade.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kRows = 1u;  // pixels of a column that an invocation does

layout(binding = 0, rgba16f) readonly uniform image2D reflectance_image;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) uniform image2D scene_image;
TEXELS(3, vec4, tunnels);
layout(push_constant, scalar) uniform Push { DaylightPush push; };

// 2 pi times what an edge adds; both ends are seen from the surface.
float edge(vec3 n, vec3 a, vec3 b) {
    const vec3 across = cross(a, b);
    const float sine = length(across);
    return sine > 0.0 ? atan(sine, dot(a, b)) * dot(n, across) / sine : 0.0;
}

// Part of all light that a surface at the origin would get from everywhere that comes through a rectangle.
float form_factor(vec3 n, vec3 corner, vec3 side, vec3 up) {
    float sum = 0.0;
    vec3 enters = vec3(0.0), leaves = vec3(0.0);  // the horizon
    bool cut = false;
    [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        const uint j = (i + 1u) & 3u;
        const vec3 a = corner + (i == 1u || i == 2u ? side : vec3(0.0)) + (i >= 2u ? up : vec3(0.0));
        const vec3 b = corner + (j == 1u || j == 2u ? side : vec3(0.0)) + (j >= 2u ? up : vec3(0.0));
        const float above_a = dot(n, a), above_b = dot(n, b);
        const bool from = above_a > 0.0, to = above_b > 0.0;
        const float t = from != to ? above_a / (above_a - above_b) : 0.0;
        const vec3 between = a + t * (b - a);
        sum += from || to ? edge(n, from ? a : between, to ? b : between) : 0.0;
        enters = to && !from ? between : enters;
        leaves = from && !to ? between : leaves;
        cut = cut || from != to;
    }
    sum += cut ? edge(n, leaves, enters) : 0.0;
    return abs(sum) * (0.5 / kPi);
}

void main() {
    const uvec2 first = gl_GlobalInvocationID.xy * uvec2(1u, kRows);
    for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        const bool inside = all(lessThan(pixel, push.size));
        const vec4 surface = imageLoad(surface_image, ivec2(pixel));
        const vec4 reflectance = imageLoad(reflectance_image, ivec2(pixel));
        const bool drawn = inside && surface.z > 0.0;
        const vec3 position = vec3(push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset, -1.0) * surface.z;
        const vec3 n = decode_normal(surface.xy);
        float part = 1.0;
        for (uint k = 0u; k < push.tunnels; ++k) {
            const vec4 start = texel_at(tunnels, int(k * kTunnelTexels)), along = texel_at(tunnels, int(k * kTunnelTexels) + 1),
                       up = texel_at(tunnels, int(k * kTunnelTexels) + 2);
            const vec3 across = cross(along.xyz, up.xyz), from = start.xyz - position;
            const float ahead = -dot(from, along.xyz), aside = dot(from, across), above = -dot(from, up.xyz);
            const bool sheltered = drawn && ahead > 0.0 && ahead < start.w && abs(aside) < along.w + kTunnelWall && above > -kTunnelWall && above < up.w + kTunnelWall;
            if (sheltered) {
                const vec3 corner = from - along.w * across, side = 2.0 * along.w * across, height = up.w * up.xyz;
                part = form_factor(n, corner, side, height) + form_factor(n, corner + start.w * along.xyz, side, height);
            }
        }
        const vec4 was = imageLoad(scene_image, ivec2(pixel));
        const vec3 light = push.illuminance * reflectance.rgb * (push.lambert * part * (reflectance.a <= kRoadKind ? road_in_diffuse(-surface.w, -dot(n, normalize(position))) : 1.0));
        if (drawn) imageStore(scene_image, ivec2(pixel), vec4(was.rgb + light, 1.0));
    }
}
