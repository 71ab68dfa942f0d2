#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Light of emitting surfaces, of the sky, and reflected light, where it is known for each pixel: adds E rho lambert.

#include "normal.glsl"
#include "sheen.glsl"
#include "shared/indirect.h"
#include "shared/shade.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kRows = 1u;  // pixels of a column that an invocation does

layout(binding = 0, rgba16f) readonly uniform image2D reflectance_image;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) uniform image2D scene_image;
layout(binding = 3, rgba32f) readonly uniform image2D illuminance_image;
layout(push_constant, scalar) uniform Push { IlluminancePush push; };

void main() {
    for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = gl_GlobalInvocationID.xy * uvec2(1u, kRows) + uvec2(0u, r);
        const vec4 surface = imageLoad(surface_image, ivec2(pixel));
        const vec4 reflectance = imageLoad(reflectance_image, ivec2(pixel));
        const vec3 ray = vec3(push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset, -1.0);
        const bool road = reflectance.a <= kRoadKind;
        const float seen = road ? road_in_diffuse(-surface.w, -dot(decode_normal(surface.xy), normalize(ray))) : 1.0;
        const vec3 light = imageLoad(illuminance_image, ivec2(pixel)).rgb * reflectance.rgb * (push.lambert * seen);
        const vec4 was = imageLoad(scene_image, ivec2(pixel));
        if (all(lessThan(pixel, push.size)) && surface.z > 0.0) imageStore(scene_image, ivec2(pixel), vec4(was.rgb + light, 1.0));
    }
}
