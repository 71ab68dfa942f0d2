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
layout(constant_id = 4) const uint kPowers = 1u;      // there are cosine powers,
layout(constant_id = 5) const uint kMaps = 1u;        // measured distributions,
layout(constant_id = 6) const uint kRoads = 1u;       // roads with a table

layout(binding = 0, rgba16f) readonly uniform image2D reflectance_image;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) uniform image2D scene_image;  // emission in, luminance out
layout(binding = 3) uniform samplerBuffer lights;
layout(binding = 4) uniform usamplerBuffer block_counts;
layout(binding = 5) uniform usamplerBuffer entries;
layout(binding = 6) uniform samplerBuffer maps;
layout(push_constant, scalar) uniform Push { ShadePush push; };

#include "maps.glsl"

const float kTableSine = 0.0261769, kNoSheenSine = 0.1736482;  // of 1.5 and of 10 degrees

vec3 position[kRows], normal[kRows], toward_eye[kRows];
uint slice_bit[kRows];        // 0: nothing is drawn
bool shiny, paved;            // whether any of the pixels has a specular lobe, or is a road with a table
vec3 sum[kRows];              // shiny: luminance, cd/m^2 RGB; otherwise what `diffuse` makes luminance

// What the luminance coefficient of a pixel needs.
float least_cosine[kRows];       // with which the threshold is taken: 0 of a matt pixel, 1 of others
vec3 diffuse[kRows], f0[kRows];  // luminance coefficient rho lambert, sr^-1; reflectance facing the surface
float f90[kRows];                // and at grazing incidence
float a2[kRows];                 // GGX alpha^2
float normal_eye[kRows], smith_eye[kRows];

// And that of a road: the direction of sight along its plane, what draws beta towards 90 degrees, and its table.
vec3 sight[kRows];
float fade[kRows], tan_cells[kRows], last_tan[kRows], first_cell[kRows];  // no cells: no road

// L pi lambert / E of a lamp on the plane that faces it, times sr: q cos(gamma) = r / cos^2(gamma) (CIE 144:2001). Beyond
// the last tan(gamma) it keeps the value it has there. Written for a light's direction times its distance.
float road_coefficient(uint r, vec3 to, float inverse, float normal_light) {
    const float cosine = max(normal_light, 1e-6), sine = sqrt(max(1.0 - cosine * cosine, 1e-12));
    const float t = min(sine / cosine, last_tan[r]);
    const float cos_beta = clamp(dot(sight[r], to) * inverse / sine, -1.0, 1.0) * fade[r];
    const vec2 at = vec2(t * tan_cells[r], arccos(cos_beta) * (float(kRoadBetaCells) / kPi));
    const vec2 cell = min(floor(at), vec2(float(kRoadTanCells) - 1.0, float(kRoadBetaCells) - 1.0));
    const vec4 corners = texelFetch(maps, int(first_cell[r] + cell.x * float(kRoadBetaCells) + cell.y));
    return interpolate(corners, at.x - cell.x, at.y - cell.y) * (1.0 + t * t);
}

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
    // Of a map.
    bool measured;
    vec3 start, turn, pole;
    float first, last_azimuth;
    vec4 grid;
};

Lamp fetch(uint index, bool cone) {
    const int texel = int(index * kTexelsPerLight);
    const vec4 a = texelFetch(lights, texel), c = texelFetch(lights, texel + 2);
    vec4 b = vec4(0.0), d = vec4(0.0), e = vec4(0.0), f = vec4(0.0);
    if (cone || kPowers != 0u) b = texelFetch(lights, texel + 1);
    if (!cone && kMaps != 0u) d = texelFetch(lights, texel + 3), e = texelFetch(lights, texel + 4), f = texelFetch(lights, texel + 5);
    return Lamp(a.xyz, a.w, b.xyz, b.w, c.rgb, c.w, kPowers == 0u || index >= push.lights.cones + push.lights.powers,
                d.xyz, cross(d.xyz, e.xyz), e.xyz, d.w, e.w, f);
}

// What a loop over lamps is for: kinds of lamps and of surfaces it may meet.
struct Loop {
    bool cones, glossy, paved;
};

// Intensity in a direction relative to the largest. `cosine` to the axis; `from` the lamp, of any length.
float relative_intensity(Lamp lamp, float cosine, vec3 from, float inverse, bool cone) {
    if (cone) {
        const float ramp = clamp(lamp.lobe_a * cosine + lamp.lobe_b, 0.0, 1.0);
        return ramp * ramp;
    }
    float relative = 0.0;
    if (kPowers != 0u) relative = cosine > 0.0 ? exp2(lamp.lobe_a * log2(cosine)) : 0.0;
    if (kMaps != 0u) {
        const vec3 d = vec3(dot(lamp.start, from), dot(lamp.turn, from), dot(lamp.pole, from));
        const float mapped = map_intensity(d, inverse, lamp.grid, lamp.first, vec2(lamp.last_azimuth, lamp.lobe_b));
        relative = lamp.measured ? mapped : relative;
    }
    return relative;
}

// Adds a lamp to the pixels of some slices, a bit for each.
void add_lamp(Lamp lamp, uint slices, Loop loop) {
    [[unroll]] for (uint r = 0u; r < kRows; ++r) {
        const vec3 to = lamp.position - position[r];
        const float inverse = inversesqrt(max(dot(to, to), 1e-12));
        const float normal_light = dot(normal[r], to) * inverse;
        const float relative = relative_intensity(lamp, -dot(lamp.axis, to) * inverse, -to, inverse, loop.cones);
        const float facing = lamp.intensity * relative * (inverse * inverse);  // illuminance facing the lamp, lx
        const bool counts_here = facing * max(normal_light, least_cosine[r]) >= push.threshold && (slice_bit[r] & slices) != 0u;
        const bool road = kRoads != 0u && loop.paved && tan_cells[r] > 0.0;
        float weight = max(normal_light, 0.0);
        if (kRoads != 0u && loop.paved) weight = road && normal_light > 0.0 ? road_coefficient(r, to, inverse, normal_light) : weight;
        const vec3 e = lamp.colour * (counts_here ? facing * weight : 0.0);
        sum[r] += loop.glossy ? e * (road ? diffuse[r] : coefficient(r, to * inverse, max(normal_light, 0.0))) : e;
    }
}

// The list of a block: entries of cones from the front, of others from the back. Or, all of them, every light there is.
struct List {
    uint cones, others, first, last;
    bool all_of_them;
};

List list_of(uint block) {
    const uint others = push.lights.powers + push.lights.maps;
    const List every_light = List(push.lights.cones, others, 0u, push.lights.cones + others - 1u, true);
    if (kEveryLight != 0u) return every_light;
    const uint cones = texelFetch(block_counts, int(2u * block)).r;
    if (cones == kAllLights) return every_light;
    const uint first = block * push.capacity;
    return List(cones, texelFetch(block_counts, int(2u * block + 1u)).r, first, first + push.capacity - 1u, false);
}

void add_entry(List list, uint at, uint number, Loop loop) {
    const uint entry = list.all_of_them ? number : texelFetch(entries, int(at)).r;
    const uint light = list.all_of_them ? number : entry & ((1u << kFirstSliceShift) - 1u);
    const uint slices = (2u << (entry >> kLastSliceShift)) - (1u << (entry >> kFirstSliceShift & 31u));
    add_lamp(fetch(light, loop.cones), list.all_of_them ? ~0u : slices, loop);
}

void add_lamps(List list, bool glossy, bool with_roads) {
    for (uint i = 0u; i < list.cones; ++i) add_entry(list, list.first + i, i, Loop(true, glossy, with_roads));
    if (kPowers == 0u && kMaps == 0u) return;
    for (uint i = 0u; i < list.others; ++i) add_entry(list, list.last - i, list.cones + i, Loop(false, glossy, with_roads));
}

void add_directional() {
    const uint first = push.lights.cones + push.lights.powers + push.lights.maps;
    for (uint i = 0u; i < push.lights.directional; ++i) {
        const Lamp lamp = fetch(first + i, true);
        [[unroll]] for (uint r = 0u; r < kRows; ++r) {
            const float normal_light = max(dot(normal[r], -lamp.axis), 0.0);
            const bool road = kRoads != 0u && tan_cells[r] > 0.0;
            float weight = normal_light;
            if (kRoads != 0u) weight = road && normal_light > 0.0 ? road_coefficient(r, -lamp.axis, 1.0, normal_light) : weight;
            const vec3 e = lamp.colour * (lamp.intensity * weight);
            sum[r] += shiny ? e * (road ? diffuse[r] : coefficient(r, -lamp.axis, normal_light)) : e;
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

// Prepares a road. Its tables hold for sight at 1 degree to its plane; towards 10 degrees beta is drawn to 90, which takes
// away the sheen.
void prepare_road(uint r, float kind) {
    tan_cells[r] = 0.0;
    if (kRoads == 0u) return;
    const bool road = kind <= kRoadKind;
    first_cell[r] = float(push.roads) + (road ? -1.0 - kind : 0.0) * float(kRoadTanCells * kRoadBetaCells + 1u);
    const vec4 head = texelFetch(maps, int(first_cell[r]) - 1);
    const float sine = dot(normal[r], toward_eye[r]);
    sight[r] = (normal[r] * sine - toward_eye[r]) * inversesqrt(max(1.0 - sine * sine, 1e-12));
    fade[r] = 1.0 - smoothstep(kTableSine, kNoSheenSine, sine);
    tan_cells[r] = road ? head.r : 0.0;
    last_tan[r] = head.g;
}

void main() {
    // A CPU device gives each thread a run of consecutive workgroups. Taking every bands-th row of the image in turn spreads
    // sky and road over the threads and still reads the images in order.
    const uint row = gl_WorkGroupID.y, turn = push.group_rows / push.bands;
    const uvec2 group = uvec2(gl_WorkGroupID.x, row % turn * push.bands + row / turn);
    const uvec2 invocation = group * gl_WorkGroupSize.xy + gl_LocalInvocationID.xy;
    const uvec2 first = invocation * uvec2(1u, kRows);

    shiny = false, paved = false;
    vec3 base[kRows], ambient[kRows];
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
        prepare_lobe(r, base[r], max(reflectance.a, 0.0), surface.w);
        prepare_road(r, reflectance.a);
        least_cosine[r] = surface.w < 1.0 ? 1.0 : 0.0;
        const bool road = tan_cells[r] > 0.0;
        shiny = shiny || (drawn && !road && (surface.w < 1.0 || reflectance.a > 0.0));
        paved = paved || (drawn && road);
        if (kRoads != 0u) diffuse[r] = road ? base[r] * (1e-4 * kPi * push.lambert) : diffuse[r];
        ambient[r] = push.ambient * base[r] * (push.lambert * (kRoads != 0u && road ? surface.w : 1.0));
        sum[r] = vec3(0.0);
    }

    // A loop for each kind of surface, of which a CPU device skips those that none of its lanes takes; it would not skip an
    // if. Lanes that could take a cheap one go along with their neighbours rather than make them wait.
    shiny = subgroupAny(shiny), paved = kRoads != 0u && subgroupAny(paved);
    const uvec2 block = min(first, push.size - 1u) / kBlockSize;
    const List list = list_of(block.y * push.blocks_x + block.x);
    const List none = List(0u, 0u, 0u, 0u, false);
    add_lamps(shiny || paved ? none : list, false, false);
    add_lamps(shiny && !paved ? list : none, true, false);
    if (kRoads != 0u) {
        add_lamps(paved && !shiny ? list : none, false, true);
        add_lamps(paved && shiny ? list : none, true, true);
    }
    add_directional();

    [[unroll]] for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        const vec3 reflected = (shiny ? sum[r] : sum[r] * diffuse[r]) + ambient[r];
        const vec3 emission = min(imageLoad(scene_image, ivec2(pixel)).rgb, vec3(push.emission_limit));
        const vec3 luminance = slice_bit[r] == 0u ? push.sky : reflected + emission;
        if (all(lessThan(pixel, push.size))) imageStore(scene_image, ivec2(pixel), vec4(luminance, 1.0));
    }
}
