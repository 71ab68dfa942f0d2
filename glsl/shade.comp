#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_vote : require

// Photometric shading: L = sum_k E_k (rho lambert + specular) + ambient + emission in cd/m^2, without any windowing of
// the inverse square. Every invocation shades kRows pixels of one column, so that a light is fetched once for all of them.
// Every block of pixels has a list of lights; each of its pixels takes those for its own slice.

#include "normal.glsl"
#include "shared/photometry.h"
#include "shared/shade.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kRows = 1u;
layout(constant_id = 3) const uint kEveryLight = 0u;  // ignore the lists, for comparison

layout(binding = 0, rgba16f) readonly uniform image2D reflectance_image;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) uniform image2D scene_image;  // emission in, luminance out
layout(binding = 3) uniform samplerBuffer lights;
layout(binding = 4) uniform usamplerBuffer block_counts;
layout(binding = 5) uniform usamplerBuffer entries;
layout(push_constant, scalar) uniform Push { ShadePush push; };

vec3 position[kRows], normal[kRows], toward_eye[kRows];
uint slice_bit[kRows];        // 0: nothing is drawn
bool shiny;                   // whether any of the pixels has a specular lobe
vec3 sum[kRows];              // shiny: luminance, cd/m^2 RGB; otherwise illuminance, lx RGB

// What the luminance coefficient of a pixel needs.
vec3 diffuse[kRows], f0[kRows];  // luminance coefficient rho lambert, sr^-1; reflectance facing the surface
float f90[kRows];                // and at grazing incidence
float a2[kRows];                 // GGX alpha^2
float normal_eye[kRows], smith_eye[kRows];

// Luminance coefficient, sr^-1: Lambert, and GGX (Walter et al. 2007) with height-correlated Smith masking (Heitz 2014) and
// Schlick's Fresnel. With s = l + v, n.h = n.s / |s| and v.h = |s| / 2, so that one division does for everything.
vec3 coefficient(uint r, vec3 toward_light, float normal_light) {
    const vec3 s = toward_light + toward_eye[r];
    const float s2 = max(dot(s, s), 1e-8);
    const float normal_s = normal_light + dot(normal[r], toward_eye[r]);
    const float bump = max(s2 - (1.0 - a2[r]) * normal_s * max(normal_s, 0.0), a2[r] * s2);  // times s2 what GGX squares
    const float smith = normal_light * smith_eye[r] + normal_eye[r] * sqrt(normal_light * normal_light * (1.0 - a2[r]) + a2[r]);
    const float lobe = a2[r] * s2 * s2 / (2.0 * kPi * bump * bump * smith);
    const float off = max(1.0 - 0.5 * sqrt(s2), 0.0), off2 = off * off, schlick = off2 * off2 * off;
    return diffuse[r] + lobe * (f0[r] + (f90[r] - f0[r]) * schlick);
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

// Adds a lamp to the pixels of some slices, a bit for each. `power`: cosine power rather than cone. `glossy`: with specular lobe.
void add_lamp(Lamp lamp, uint slices, bool power, bool glossy) {
    [[unroll]] for (uint r = 0u; r < kRows; ++r) {
        const vec3 to = lamp.position - position[r];
        const float inverse = inversesqrt(max(dot(to, to), 1e-12));
        const float normal_light = dot(normal[r], to) * inverse;
        const float cosine = -dot(lamp.axis, to) * inverse;
        float relative;
        if (power) {
            relative = cosine > 0.0 ? exp2(lamp.lobe_a * log2(cosine)) : 0.0;
        } else {
            const float ramp = clamp(lamp.lobe_a * cosine + lamp.lobe_b, 0.0, 1.0);
            relative = ramp * ramp;
        }
        const float facing = lamp.intensity * relative * (inverse * inverse);  // illuminance facing the lamp, lx
        const bool counts_here = facing >= push.threshold && (slice_bit[r] & slices) != 0u;
        const vec3 e = lamp.colour * (counts_here ? facing * max(normal_light, 0.0) : 0.0);
        sum[r] += glossy ? e * coefficient(r, to * inverse, max(normal_light, 0.0)) : e;
    }
}

// The list of a block: entries of cones from the front, of powers from the back. Or, all of them, every light there is.
struct List {
    uint cones, powers, first, last;
    bool all_of_them;
};

List list_of(uint block) {
    const List every_light = List(push.lights.cones, push.lights.powers, 0u, push.lights.cones + push.lights.powers - 1u, true);
    if (kEveryLight != 0u) return every_light;
    const uint cones = texelFetch(block_counts, int(2u * block)).r;
    if (cones == kAllLights) return every_light;
    const uint first = block * push.capacity;
    return List(cones, texelFetch(block_counts, int(2u * block + 1u)).r, first, first + push.capacity - 1u, false);
}

void add_entry(List list, uint at, uint number, bool power, bool glossy) {
    const uint entry = list.all_of_them ? number : texelFetch(entries, int(at)).r;
    const uint light = list.all_of_them ? number : entry & ((1u << kFirstSliceShift) - 1u);
    const uint slices = (2u << (entry >> kLastSliceShift)) - (1u << (entry >> kFirstSliceShift & 31u));
    add_lamp(fetch(light), list.all_of_them ? ~0u : slices, power, glossy);
}

void add_lamps(List list, bool glossy) {
    for (uint i = 0u; i < list.cones; ++i) add_entry(list, list.first + i, i, false, glossy);
    for (uint i = 0u; i < list.powers; ++i) add_entry(list, list.last - i, list.cones + i, true, glossy);
}

void add_directional() {
    const uint first = push.lights.cones + push.lights.powers;
    for (uint i = 0u; i < push.lights.directional; ++i) {
        const Lamp lamp = fetch(first + i);
        [[unroll]] for (uint r = 0u; r < kRows; ++r) {
            const float normal_light = max(dot(normal[r], -lamp.axis), 0.0);
            const vec3 e = lamp.colour * (lamp.intensity * normal_light);
            sum[r] += shiny ? e * coefficient(r, -lamp.axis, normal_light) : e;
        }
    }
}

// Prepares the specular lobe of a pixel. A dielectric's 4 % fades out as its lobe widens to a Lambert one, which its
// reflectance already holds.
void prepare_lobe(uint r, vec3 base, float metallic, float roughness) {
    const float a = roughness * roughness, cosine = dot(normal[r], toward_eye[r]);
    diffuse[r] = base * ((1.0 - metallic) * push.lambert);
    f0[r] = mix(vec3(0.04 * (1.0 - a * a)), base, metallic);
    f90[r] = clamp(25.0 * max(f0[r].r, max(f0[r].g, f0[r].b)), 0.0, 1.0);
    a2[r] = max(a, 1e-3) * max(a, 1e-3);
    normal_eye[r] = max(cosine, 1e-4);
    smith_eye[r] = sqrt(normal_eye[r] * normal_eye[r] * (1.0 - a2[r]) + a2[r]);
}

void main() {
    // A CPU device gives each thread a run of consecutive workgroups. Taking every bands-th row of the image in turn spreads
    // sky and road over the threads and still reads the images in order.
    const uint row = gl_WorkGroupID.y, turn = push.group_rows / push.bands;
    const uvec2 group = uvec2(gl_WorkGroupID.x, row % turn * push.bands + row / turn);
    const uvec2 invocation = group * gl_WorkGroupSize.xy + gl_LocalInvocationID.xy;
    const uvec2 first = invocation * uvec2(1u, kRows);

    shiny = false;
    vec3 base[kRows];
    [[unroll]] for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        const vec4 surface = imageLoad(surface_image, ivec2(pixel));
        const vec4 reflectance = imageLoad(reflectance_image, ivec2(pixel));
        const bool drawn = surface.z > 0.0 && all(lessThan(pixel, push.size));
        const float depth = drawn ? surface.z : 1.0;
        const float slice = log2(depth) * push.grid.slice_scale + push.grid.slice_bias;
        slice_bit[r] = drawn ? 1u << uint(clamp(slice, 0.0, float(push.grid.slices) - 1.0)) : 0u;
        position[r] = vec3(push.grid.ray_scale * (vec2(pixel) + 0.5) + push.grid.ray_offset, -1.0) * depth;
        normal[r] = decode_normal(surface.xy);
        toward_eye[r] = normalize(-position[r]);
        base[r] = reflectance.rgb;
        shiny = shiny || (drawn && (surface.w < 1.0 || reflectance.a > 0.0));
        prepare_lobe(r, base[r], reflectance.a, surface.w);
        sum[r] = vec3(0.0);
    }

    // Two loops, of which a CPU device skips the one that none of its lanes takes; it would not skip an if. Lanes that could
    // take the cheap one go along with their neighbours rather than make them wait.
    shiny = subgroupAny(shiny);
    const uvec2 block = min(first, push.size - 1u) / kBlockSize;
    const List list = list_of(block.y * push.blocks_x + block.x);
    const List none = List(0u, 0u, 0u, 0u, false);
    add_lamps(shiny ? none : list, false);
    add_lamps(shiny ? list : none, true);
    add_directional();

    [[unroll]] for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        const vec3 reflected = (shiny ? sum[r] : sum[r] * diffuse[r]) + push.ambient * base[r] * push.lambert;
        const vec3 emission = min(imageLoad(scene_image, ivec2(pixel)).rgb, vec3(push.emission_limit));
        const vec3 luminance = slice_bit[r] == 0u ? push.sky : reflected + emission;
        if (all(lessThan(pixel, push.size))) imageStore(scene_image, ivec2(pixel), vec4(luminance, 1.0));
    }
}
