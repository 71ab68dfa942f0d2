#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// A sky that is a picture: itself where nothing is drawn; elsewhere its diffuse reflection, by the illuminance on the surface,
// and its specular one, by the sky blurred to the lobe and the fraction that the lobe reflects (Karis 2013). Runs after the
// lamps and adds to them.

#include "normal.glsl"
#include "sheen.glsl"
#include "texels.glsl"
#include "shared/shade.h"
#include "shared/sky.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kRows = 1u;  // pixels of a column that an invocation does

layout(binding = 0, rgba16f) readonly uniform image2D reflectance_image;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) uniform image2D scene_image;
TEXELS(3, vec4, sky);
layout(push_constant, scalar) uniform Push { SkyPush push; };

vec3 bilinear(vec2 place, uint first, uint side) {
    const ivec2 corner = clamp(ivec2(floor(place)), ivec2(0), ivec2(side));
    const vec2 t = clamp(place - vec2(corner), 0.0, 1.0);
    const int pitch = int(side + 2u), at = int(first) + corner.y * pitch + corner.x;
    return mix(mix(texel_at(sky, at).rgb, texel_at(sky, at + 1).rgb, t.x),
               mix(texel_at(sky, at + pitch).rgb, texel_at(sky, at + pitch + 1).rgb, t.x), t.y);
}

vec3 look_up(vec2 octahedral, uint first, uint side) {
    return bilinear((octahedral * 0.5 + 0.5) * float(side) + 0.5, first, side);
}

vec3 to_world(vec3 v) { return push.right * v.x + push.up * v.y + push.back * v.z; }

// The sky as a lobe of some roughness sees it: between two maps, or the sharp one and the first.
vec3 blurred(vec3 direction, float roughness) {
    const vec2 octahedral = encode_normal(direction);
    const float level = clamp(roughness, 0.0, 1.0) * float(kSkyLobes);
    const uint below = min(uint(level), kSkyLobes - 1u);
    const uint above = kSkyLobesStart + below * kSkyLobeTexels;
    const bool sharp = below == 0u;
    const vec3 low = look_up(octahedral, sharp ? kSkySharpStart : above - kSkyLobeTexels, sharp ? push.sharp_side : kSkyLobeSide);
    return mix(low, look_up(octahedral, above, kSkyLobeSide), level - float(below));
}

// Fractions of F0 and F90 that are reflected of uniform light.
vec2 reflected(float normal_eye, float roughness) {
    const vec2 place = clamp(vec2(sqrt(normal_eye), roughness), 0.0, 1.0) * float(kSpecularSide - 1u);
    const ivec2 corner = clamp(ivec2(place), ivec2(0), ivec2(kSpecularSide - 2u));
    const vec2 t = place - vec2(corner);
    const int at = int(kSkyPolynomial) + corner.y * int(kSpecularSide) + corner.x;
    return mix(mix(texel_at(sky, at).xy, texel_at(sky, at + 1).xy, t.x),
               mix(texel_at(sky, at + int(kSpecularSide)).xy, texel_at(sky, at + int(kSpecularSide) + 1).xy, t.x), t.y);
}

void main() {
    vec3 c[kSkyPolynomial];
    for (uint i = 0u; i < kSkyPolynomial; ++i) c[i] = texel_at(sky, int(i)).rgb;
    const uvec2 first = gl_GlobalInvocationID.xy * uvec2(1u, kRows);
    for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        const bool inside = all(lessThan(pixel, push.size));
        const vec4 surface = imageLoad(surface_image, ivec2(pixel));
        const vec4 reflectance = imageLoad(reflectance_image, ivec2(pixel));
        const bool drawn = surface.z > 0.0;
        const vec3 ray = to_world(vec3(push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset, -1.0));
        // A retroreflective surface is a dielectric.
        const bool road = reflectance.a <= kRoadKind;
        const float metallic = reflectance.a >= 0.0 && reflectance.a <= 1.0 ? reflectance.a : 0.0;
        const bool shiny = inside && drawn && !road && (surface.w < 1.0 || metallic > 0.0);
        const vec3 n = to_world(decode_normal(surface.xy));
        const float normal_eye = clamp(-dot(n, ray) * inversesqrt(dot(ray, ray)), 0.0, 1.0);

        const vec3 illuminance = c[0] + c[1] * n.y + c[2] * n.z + c[3] * n.x + c[4] * (n.x * n.y) + c[5] * (n.y * n.z) +
                                 c[6] * (3.0 * n.z * n.z - 1.0) + c[7] * (n.x * n.z) + c[8] * (n.x * n.x - n.y * n.y);
        vec3 luminance = imageLoad(scene_image, ivec2(pixel)).rgb +
                         max(illuminance, vec3(0.0)) * reflectance.rgb * ((road ? road_in_diffuse(-surface.w, normal_eye) : 1.0 - metallic) * push.lambert);

        if (shiny) {
            const float a = surface.w * surface.w;
            const vec3 f0 = mix(vec3(0.04 * (1.0 - a * a)), reflectance.rgb, metallic);
            const float f90 = clamp(25.0 * max(f0.r, max(f0.g, f0.b)), 0.0, 1.0);
            const vec2 fraction = reflected(normal_eye, surface.w);
            const vec3 mirrored = ray - 2.0 * dot(n, ray) * n;
            luminance += blurred(mirrored, surface.w) * (f0 * fraction.x + f90 * fraction.y);
        }
        if (!drawn) luminance = look_up(encode_normal(ray), kSkySharpStart, push.sharp_side);
        if (inside) imageStore(scene_image, ivec2(pixel), vec4(luminance, 1.0));
    }
}
