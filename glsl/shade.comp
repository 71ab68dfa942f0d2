#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Photometric shading: L = sum_k E_k (rho lambert + specular) + ambient + emission in cd/m^2, without any windowing of
// the inverse square. Every invocation shades kRows pixels of one column, so that a light is fetched once for all of them;
// it walks the froxels its pixels lie in, and adds to each pixel only the lights of that pixel's own froxel.

#include "shared/photometry.h"
#include "shared/shade.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kRows = 1u;
layout(constant_id = 3) const uint kEveryLight = 0u;  // ignore the lists, for comparison

layout(binding = 0, rgba16f) readonly uniform image2D reflectance_image;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) readonly uniform image2D emission_image;
layout(binding = 3) uniform samplerBuffer lights;
layout(binding = 4) uniform usamplerBuffer counts;
layout(binding = 5) uniform usamplerBuffer indices;
layout(binding = 6, rgba32f) writeonly uniform image2D scene_image;
layout(push_constant, scalar) uniform Push { ShadePush push; };

const uint kNoSlice = 32u;  // of a pixel where nothing is drawn

vec3 position[kRows], normal[kRows], toward_eye[kRows];
float alpha_squared[kRows], normal_eye[kRows];  // GGX a^2, cosine towards the eye
uint slice[kRows];
vec3 diffuse[kRows];                  // illuminance, lx RGB
vec3 specular[kRows], grazing[kRows]; // sums that F0 and F90 multiply, cd/m^2 RGB
uint shiny;                           // 1 if any of the pixels has a specular lobe

vec3 decode_normal(vec2 p) {
    const float z = 1.0 - abs(p.x) - abs(p.y);
    const vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return normalize(vec3(z < 0.0 ? folded : p, z));
}

// GGX distribution (Walter et al. 2007) times height-correlated Smith visibility (Heitz 2014), without Fresnel.
float microfacets(uint r, float normal_half, float normal_light) {
    const float a2 = alpha_squared[r];
    const float bump = normal_half * normal_half * (a2 - 1.0) + 1.0;
    const float smith = normal_light * sqrt(normal_eye[r] * normal_eye[r] * (1.0 - a2) + a2) +
                        normal_eye[r] * sqrt(normal_light * normal_light * (1.0 - a2) + a2);
    return 0.5 * a2 / (kPi * bump * bump * smith);
}

// Light of illuminance e (lx RGB, on the surface) arriving from a direction.
void reflect_light(uint r, vec3 e, vec3 toward_light, float normal_light) {
    const vec3 half_way = normalize(toward_light + toward_eye[r]);
    const float lobe = microfacets(r, clamp(dot(normal[r], half_way), 0.0, 1.0), normal_light);
    const float off = 1.0 - clamp(dot(toward_eye[r], half_way), 0.0, 1.0);
    const float off2 = off * off;
    const float schlick = off2 * off2 * off;
    specular[r] += e * (lobe * (1.0 - schlick));
    grazing[r] += e * (lobe * schlick);
}

struct Lamp {
    vec3 position;
    float intensity;
    vec3 axis;
    float lobe_a;
    vec3 colour;
    float lobe_b;
};

Lamp fetch(uint index) {
    const int texel = int(index * kTexelsPerLight);
    const vec4 a = texelFetch(lights, texel), b = texelFetch(lights, texel + 1), c = texelFetch(lights, texel + 2);
    return Lamp(a.xyz, a.w, b.xyz, b.w, c.rgb, c.w);
}

// Adds a lamp to the pixels whose froxel is `at`. `power`: cosine power rather than cone.
void add_lamp(Lamp lamp, uint at, bool power) {
    for (uint r = 0u; r < kRows; ++r) {
        const vec3 to = lamp.position - position[r];
        const float inverse = inversesqrt(max(dot(to, to), 1e-12));
        const vec3 toward_light = to * inverse;
        const float normal_light = dot(normal[r], toward_light);
        const float cosine = -dot(lamp.axis, toward_light);
        float relative;
        if (power) {
            relative = cosine > 0.0 ? exp2(lamp.lobe_a * log2(cosine)) : 0.0;
        } else {
            const float ramp = clamp(lamp.lobe_a * cosine + lamp.lobe_b, 0.0, 1.0);
            relative = ramp * ramp;
        }
        const float facing = lamp.intensity * relative * (inverse * inverse);  // illuminance facing the lamp, lx
        const bool counts_here = facing >= push.threshold && normal_light > 0.0 && slice[r] == at;
        const vec3 e = lamp.colour * (counts_here ? facing * normal_light : 0.0);
        diffuse[r] += e;
        // A loop of no or one turn: a CPU device jumps over it where no pixel is shiny, and would not over an if.
        for (uint turn = 0u; turn < shiny; ++turn)
            if (counts_here) reflect_light(r, e, toward_light, normal_light);
    }
}

void add_froxel(uvec2 pixel, uint at) {
    uint cones = push.lights.cones, powers = push.lights.powers, list = 0u;
    bool all_of_them = true;
    if (kEveryLight == 0u) {
        const uvec2 tile = pixel / kTileSize;
        const uint cell = (at * push.grid.tiles_y + tile.y) * push.grid.tiles_x + tile.x;
        const uint listed = texelFetch(counts, int(2u * cell)).r;
        all_of_them = listed == kAllLights;
        if (!all_of_them) {
            cones = listed;
            powers = texelFetch(counts, int(2u * cell + 1u)).r;
            list = cell * push.grid.capacity;
        }
    }
    for (uint i = 0u; i < cones; ++i)
        add_lamp(fetch(all_of_them ? i : texelFetch(indices, int(list + i)).r), at, false);
    for (uint i = 0u; i < powers; ++i)
        add_lamp(fetch(all_of_them ? cones + i : texelFetch(indices, int(list + cones + i)).r), at, true);
}

void add_directional() {
    const uint first = push.lights.cones + push.lights.powers;
    for (uint i = 0u; i < push.lights.directional; ++i) {
        const Lamp lamp = fetch(first + i);
        for (uint r = 0u; r < kRows; ++r) {
            const float normal_light = dot(normal[r], -lamp.axis);
            const bool lit = normal_light > 0.0 && slice[r] != kNoSlice;
            const vec3 e = lamp.colour * (lit ? lamp.intensity * normal_light : 0.0);
            diffuse[r] += e;
            if (lit && shiny != 0u) reflect_light(r, e, -lamp.axis, normal_light);
        }
    }
}

void main() {
    const uint block = gl_WorkGroupID.x * push.block_step % push.blocks;
    const uvec2 corner = uvec2(block % push.blocks_x, block / push.blocks_x) * gl_WorkGroupSize.xy * uvec2(1u, kRows);
    const uvec2 first = corner + gl_LocalInvocationID.xy * uvec2(1u, kRows);

    uint slices = 0u;
    shiny = 0u;
    for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        const vec4 surface = imageLoad(surface_image, ivec2(pixel));
        const bool drawn = surface.z > 0.0 && all(lessThan(pixel, push.size));
        const float depth = drawn ? surface.z : 1.0;
        const vec2 ray = push.grid.ray_scale * (vec2(pixel) + 0.5) + push.grid.ray_offset;
        position[r] = vec3(ray, -1.0) * depth;
        normal[r] = decode_normal(surface.xy);
        toward_eye[r] = normalize(-position[r]);
        normal_eye[r] = max(dot(normal[r], toward_eye[r]), 1e-4);
        const float a = max(surface.w * surface.w, 1e-3);
        alpha_squared[r] = a * a;
        slice[r] = kNoSlice;
        if (drawn) {
            slice[r] = uint(clamp(log2(depth) * push.grid.slice_scale + push.grid.slice_bias, 0.0, float(push.grid.slices) - 1.0));
            slices |= 1u << slice[r];
            const float metallic = imageLoad(reflectance_image, ivec2(pixel)).a;
            if (surface.w < 1.0 || metallic > 0.0) shiny = 1u;
        }
        diffuse[r] = specular[r] = grazing[r] = vec3(0.0);
    }

    while (slices != 0u) {
        const uint at = uint(findLSB(slices));
        slices &= slices - 1u;
        add_froxel(first, at);
    }
    add_directional();

    for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        const vec4 reflectance = imageLoad(reflectance_image, ivec2(pixel));
        const vec3 base = reflectance.rgb, rho = base * (1.0 - reflectance.a);
        const float roughness = imageLoad(surface_image, ivec2(pixel)).w;
        const float a2 = roughness * roughness * roughness * roughness;
        // A dielectric's 4 % fades out as its lobe widens to a Lambert one, which its reflectance already holds.
        const vec3 f0 = mix(vec3(0.04 * (1.0 - a2)), base, reflectance.a);
        const float f90 = clamp(25.0 * max(f0.r, max(f0.g, f0.b)), 0.0, 1.0);
        const vec3 emission = min(imageLoad(emission_image, ivec2(pixel)).rgb, vec3(push.emission_limit));
        const vec3 reflected = (diffuse[r] * rho + push.ambient * base) * push.lambert + f0 * specular[r] + f90 * grazing[r];
        const vec3 luminance = slice[r] == kNoSlice ? push.sky : reflected + emission;
        if (all(lessThan(pixel, push.size))) imageStore(scene_image, ivec2(pixel), vec4(luminance, 1.0));
    }
}
