#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Photometric shading: L = sum_k E_k (rho lambert + specular) + ambient + emission in cd/m^2, without any windowing of
// the inverse square. Every invocation shades kRows pixels of one column, so that a lamp is fetched once for all of them.
// Every block of pixels has a list of lamps, of which its pixels take those for their own slice, and the sum of others
// (shared/blocks.h). A dispatch does the blocks of one class, side by side in workgroups, whatever their places in the image.

#include "blocks.glsl"
#include "normal.glsl"
#include "texels.glsl"
#include "shared/photometry.h"
#include "shared/blocks.h"
#include "shared/clipmap.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kRows = 1u;
layout(constant_id = 3) const uint kEveryLamp = 0u;  // ignore the lists, for comparison
layout(constant_id = 4) const uint kCones = 1u;       // there are points and spots,
layout(constant_id = 5) const uint kPowers = 1u;      // cosine powers,
layout(constant_id = 6) const uint kTables = 1u;        // measured distributions
layout(constant_id = 7) const uint kListed = 1u;      // on lists
layout(constant_id = 8) const uint kMerged = 1u;    // or added up;
layout(constant_id = 9) const uint kGlossy = 1u;      // surfaces with a specular lobe,
layout(constant_id = 10) const uint kRoads = 1u;      // roads with a table,
layout(constant_id = 11) const uint kRetro = 1u;      // retroreflective surfaces,
layout(constant_id = 12) const uint kMaps = 1u;       // shadow maps of lamps,
layout(constant_id = 13) const uint kLookups = 1u;    // which pixels look up where every lamp counts,
layout(constant_id = 14) const uint kClipmaps = 1u;  // and of directional lamps

layout(binding = 0, rgba16f) readonly uniform image2D reflectance_image;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) uniform image2D scene_image;  // emission in, luminance out
TEXELS(3, vec4, lamps);
TEXELS(4, uint, block_counts);
TEXELS(5, uint, entries);
TEXELS(6, vec4, tables);
TEXELS(7, vec4, retro_classes);
TEXELS(8, vec4, merged);
TEXELS(9, uint, class_counts);
TEXELS(10, uint, class_blocks);
TEXELS(11, vec4, maps);
HALVES(12, distances);
TEXELS(13, uint, shares);
TEXELS(14, uint, directional_shares);
TEXELS(15, uint, froxel_counts);
TEXELS(16, uint, froxel_lamps);
TEXELS(17, uint, block_slices);
layout(push_constant, scalar) uniform Push { ShadePush push; };

#include "lamp.glsl"
#include "retro.glsl"
#include "road.glsl"
#include "shadows/lookup.glsl"

vec3 position[kRows], normal[kRows], toward_eye[kRows];
uint in_slice[kRows];         // a bit; 0: nothing is drawn
vec3 sum[kRows];              // with kGlossy or kRetro luminance, cd/m^2 RGB; otherwise what `diffuse` makes luminance

const bool kShiny = kGlossy != 0u || kRetro != 0u;

// What the luminance coefficient of a pixel needs.
float least_cosine[kRows];       // with which the threshold is taken: 0 of a matt pixel, 1 of others
vec3 diffuse[kRows], f0[kRows];  // luminance coefficient rho lambert, sr^-1; reflectance facing the surface
float f90[kRows];                // and at grazing incidence
float a2[kRows];                 // GGX alpha^2
float normal_eye[kRows], smith_eye[kRows];

uint sheet[kRows];               // class of retroreflection
float chord2[kRows];             // and how far from the eye's direction it returns light, see RetroBase; -1: not at all

Road roads[kRows];

// Luminance coefficient, sr^-1: Lambert, and GGX (Walter et al. 2007) with height-correlated Smith masking (Heitz 2014) and
// Schlick's Fresnel. With s = l + v, n.h = n.s / |s| and v.h = |s| / 2, so that one division does for everything.
vec3 coefficient(uint r, vec3 toward_lamp, float normal_lamp) {
    const vec3 s = toward_lamp + toward_eye[r];
    const float s2 = max(dot(s, s), 1e-8);
    const float normal_s = normal_lamp + dot(normal[r], toward_eye[r]);
    // Times s2 what GGX squares: s2 - (1 - a2) (n.s)^2, as a sum, since for smooth surfaces that is a difference of equals.
    const vec3 aside = cross(normal[r], s);
    const float bump = normal_s > 0.0 ? dot(aside, aside) + a2[r] * normal_s * normal_s : s2;
    const float smith = normal_lamp * smith_eye[r] + normal_eye[r] * sqrt(normal_lamp * normal_lamp * (1.0 - a2[r]) + a2[r]);
    const float lobe = a2[r] * s2 * s2 / (2.0 * kPi * bump * bump * smith);
    const float off = max(1.0 - 0.5 * sqrt(s2), 0.0), off2 = off * off, schlick = off2 * off2 * off;
    return diffuse[r] + lobe * (f0[r] + (f90[r] - f0[r]) * schlick);
}

// What a retroreflective pixel adds to that, per illuminance facing the lamp.
vec3 sheet_coefficient(uint r, vec3 toward_lamp, float normal_lamp) {
    return diffuse[r] * (retroreflection(sheet[r], toward_lamp, toward_eye[r], normal_lamp, normal_eye[r]) / push.lambert);
}

bool returns_light(uint r, vec3 toward_lamp, float normal_lamp) {
    const vec3 chord = toward_lamp - toward_eye[r];
    return dot(chord, chord) <= chord2[r] && normal_lamp > 0.0;
}

float seen[kRows];  // share of a lamp that each pixel sees

// Finds how much the pixels see of a lamp that something may hide from some of them.
void look_up(uint index, vec3 position_of_lamp, uint entry, uint block, bool every_lamp) {
    const float share = every_lamp ? 1.0 : share_of(entry);
    [[unroll]] for (uint r = 0u; r < kRows; ++r) seen[r] = share;
    if (!every_lamp && (entry & kMixedBit) != 0u) {
        const uint column = gl_LocalInvocationID.x % kBlockSize, row = gl_LocalInvocationID.y * kRows % kBlockSize;
        const uint word = texel_at(shares, int((block * kSharePlaces + place_of(entry)) * kBlockSize + column)).r;
        [[unroll]] for (uint r = 0u; r < kRows; ++r) seen[r] = float(word >> 4u * (row + r) & 15u) / 15.0;
    }
    if (kLookups == 0u) return;
    if (every_lamp) {
        const FetchedMap map = fetch_map(index);
        [[unroll]] for (uint r = 0u; r < kRows; ++r) {
            const vec3 from = position[r] - position_of_lamp;
            seen[r] = visibility(map, from, normal[r], texels_per_pixel(map, from, position[r], normal[r], push.grid.ray_scale));
        }
    }
}

// Adds a lamp to the pixels of some slices, a bit for each.
void add_lamp(FetchedLamp lamp, uint slices, bool cone) {
    float returned[kRows];  // of what a retroreflective pixel returns, the illuminance facing the lamp, lx
    bool any_returned = false;
    [[unroll]] for (uint r = 0u; r < kRows; ++r) {
        const vec3 to = lamp.position - position[r];
        const float inverse = inversesqrt(max(dot(to, to), 1e-12));
        const float normal_lamp = dot(normal[r], to) * inverse;
        const float relative = relative_intensity(lamp, -dot(lamp.axis, to) * inverse, -to, inverse, cone);
        float facing = lamp.intensity * relative * (inverse * inverse);  // illuminance facing the lamp, lx
        const bool counts_here = facing * max(normal_lamp, least_cosine[r]) >= push.threshold && (in_slice[r] & slices) != 0u;
        if (kMaps != 0u) facing *= seen[r];
        const bool road = kRoads != 0u && roads[r].tan_cells > 0.0;
        float weight = max(normal_lamp, 0.0);
        if (kRoads != 0u) weight = road && normal_lamp > 0.0 ? road_coefficient(roads[r], to, inverse, normal_lamp) : weight;
        const vec3 e = lamp.colour * (counts_here ? facing * weight : 0.0);
        sum[r] += kShiny ? e * (road ? diffuse[r] : coefficient(r, to * inverse, max(normal_lamp, 0.0))) : e;
        if (kRetro != 0u) {
            returned[r] = counts_here && returns_light(r, to * inverse, normal_lamp) ? facing : 0.0;
            any_returned = any_returned || returned[r] > 0.0;
        }
    }
    if (kRetro == 0u) return;
    if (any_returned)  // few lamps are near the line of sight
        [[unroll]] for (uint r = 0u; r < kRows; ++r) {
            const vec3 toward = normalize(lamp.position - position[r]);
            sum[r] += lamp.colour * returned[r] * sheet_coefficient(r, toward, max(dot(normal[r], toward), 0.0));
        }
}

// The list of a block: entries of cones from the front, of others from the back. Or, all of them, every lamp there is.
struct List {
    uint block, cones, others, first, last;
    bool all_of_them;
};

List list_of(uint block) {
    const uint others = push.lamps.powers + push.lamps.tables;
    const List every_lamp = List(block, push.lamps.cones, others, 0u, push.lamps.cones + others - 1u, true);
    if (kEveryLamp != 0u) return every_lamp;
    const uint cones = texel_at(block_counts, int(2u * block)).r;
    if (cones == kAllLamps) return every_lamp;
    const uint first = block * push.capacity;
    return List(block, cones, texel_at(block_counts, int(2u * block + 1u)).r, first, first + push.capacity - 1u, false);
}

void add_listed(uint index, uint entry, uint slices, uint block, bool cone, bool every_lamp) {
    const FetchedLamp lamp = fetch(index, cone, push.lamps.cones + push.lamps.powers);
    if (kMaps != 0u) look_up(index, lamp.position, entry, block, every_lamp);
    add_lamp(lamp, slices, cone);
}

void add_entry(List list, uint at, uint number, bool cone) {
    const uint entry = list.all_of_them ? number : texel_at(entries, int(at)).r;
    add_listed(list.all_of_them ? number : lamp_of(entry), entry, list.all_of_them ? ~0u : slices_of(entry), list.block, cone, list.all_of_them);
}

void add_lamps(List list) {
    if (kCones != 0u)
        for (uint i = 0u; i < list.cones; ++i) add_entry(list, list.first + i, i, true);
    if (kPowers != 0u || kTables != 0u)
        for (uint i = 0u; i < list.others; ++i) add_entry(list, list.last - i, list.cones + i, false);
}

// Whether the lists of a block's froxels are shorter together than one of all lamps. One that overflowed is longer than any.
bool has_froxel_lists(uint slices, uvec2 tile) {
    uint sum = 0u;
    for (uint left = slices; left != 0u; left &= left - 1u) {
        const int froxel = int(froxel_of(push.grid, tile, uint(findLSB(left))));
        const uint cones = texel_at(froxel_counts, 2 * froxel).r;
        sum += cones == kAllLamps ? kAllLamps / 64u : cones + texel_at(froxel_counts, 2 * froxel + 1).r;
    }
    return sum < push.lamps.cones + push.lamps.powers + push.lamps.tables;
}

// Of a block whose list has overflowed, slice by slice: each pixel counts the lamps of its own froxel.
void add_froxels(uint block, uint slices, uvec2 tile) {
    for (uint left = slices; left != 0u; left &= left - 1u) {
        const uint bit = left & (~left + 1u), froxel = froxel_of(push.grid, tile, uint(findLSB(left)));
        const uint cones = texel_at(froxel_counts, int(2u * froxel)).r, others = texel_at(froxel_counts, int(2u * froxel + 1u)).r;
        const uint first = froxel * push.grid.capacity;
        if (kCones != 0u)
            for (uint i = 0u; i < cones; ++i) add_listed(texel_at(froxel_lamps, int(first + i)).r, 0u, bit, block, true, true);
        if (kPowers != 0u || kTables != 0u)
            for (uint i = cones; i < cones + others; ++i) add_listed(texel_at(froxel_lamps, int(first + i)).r, 0u, bit, block, false, true);
    }
}

void add_lamps_of(uint block, uvec2 corner) {
    List list = list_of(block);
    const uint slices = kEveryLamp == 0u && list.all_of_them ? texel_at(block_slices, int(block)).r : 0u;
    const uvec2 tile = corner / kTileSize;
    if (slices != 0u && has_froxel_lists(slices, tile)) {
        add_froxels(block, slices, tile);
        list.cones = 0u, list.others = 0u;
    }
    add_lamps(list);
}

void add_directional(uint block) {
    const uint first = push.lamps.cones + push.lamps.powers + push.lamps.tables;
    const uint words = (push.lamps.directional + kSharesPerWord - 1u) / kSharesPerWord;
    const uint pixel = gl_LocalInvocationID.y * kRows % kBlockSize * kBlockSize + gl_LocalInvocationID.x % kBlockSize;
    for (uint i = 0u; i < push.lamps.directional; ++i) {
        FetchedLamp lamp = fetch(first + i, true, 0u);
        const float facing = lamp.intensity;
        [[unroll]] for (uint r = 0u; r < kRows; ++r) {
            if (kClipmaps != 0u) {
                const uint word = (block * words + i / kSharesPerWord) * kBlockSize * kBlockSize + pixel + r * kBlockSize;
                const uint share = texel_at(directional_shares, int(word)).r >> 8u * (i % kSharesPerWord) & 255u;
                lamp.intensity = facing * (float(share) / 255.0);
            }
            const float normal_lamp = max(dot(normal[r], -lamp.axis), 0.0);
            const bool road = kRoads != 0u && roads[r].tan_cells > 0.0;
            float weight = normal_lamp;
            if (kRoads != 0u) weight = road && normal_lamp > 0.0 ? road_coefficient(roads[r], -lamp.axis, 1.0, normal_lamp) : weight;
            const vec3 e = lamp.colour * (lamp.intensity * weight);
            sum[r] += kShiny ? e * (road ? diffuse[r] : coefficient(r, -lamp.axis, normal_lamp)) : e;
            if (kRetro != 0u && returns_light(r, -lamp.axis, normal_lamp)) sum[r] += lamp.colour * lamp.intensity * sheet_coefficient(r, -lamp.axis, normal_lamp);
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

// Starts from what has been added up over the block.
void add_merged(uint block, uvec2 first) {
    vec4 t[kMergedTexels];
    [[unroll]] for (uint k = 0u; k < kMergedTexels; ++k) t[k] = texel_at(merged, int(block * kMergedTexels + k));
    const vec3 node[9] = vec3[](t[0].rgb, vec3(t[0].a, t[1].rg), vec3(t[1].ba, t[2].r), t[2].gba, t[3].rgb, vec3(t[3].a, t[4].rg),
                                vec3(t[4].ba, t[5].r), t[5].gba, t[6].rgb);
    const float step_ = 2.0 / float(kBlockSize - 1u);
    const float u = float(first.x % kBlockSize) * step_ - 1.0;
    vec3 column[3];
    [[unroll]] for (uint j = 0u; j < 3u; ++j)
        column[j] = 0.5 * u * (u - 1.0) * node[3u * j] + (1.0 - u * u) * node[3u * j + 1u] + 0.5 * u * (u + 1.0) * node[3u * j + 2u];
    [[unroll]] for (uint r = 0u; r < kRows; ++r) {
        const float v = float((first.y + r) % kBlockSize) * step_ - 1.0;
        sum[r] += 0.5 * v * (v - 1.0) * column[0] + (1.0 - v * v) * column[1] + 0.5 * v * (v + 1.0) * column[2];
    }
}

void main() {
    const uint place = gl_WorkGroupID.x * kBlocksPerGroup + gl_LocalInvocationID.x / kBlockSize;
    const bool there = place < texel_at(class_counts, int(push.block_class * kClassWords + 3u)).r;
    const uint block = there ? texel_at(class_blocks, int(push.block_class * push.blocks + place)).r : 0u;
    const uvec2 corner = uvec2(block % push.blocks_x, block / push.blocks_x) * kBlockSize;
    const uvec2 first = corner + uvec2(gl_LocalInvocationID.x % kBlockSize, gl_LocalInvocationID.y * kRows);

    vec3 base[kRows], ambient[kRows];
    [[unroll]] for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        const vec4 surface = imageLoad(surface_image, ivec2(pixel));
        const vec4 reflectance = imageLoad(reflectance_image, ivec2(pixel));
        const bool drawn = surface.z > 0.0 && all(lessThan(pixel, push.size));
        const float depth = drawn ? surface.z : 1.0;
        in_slice[r] = drawn ? slice_bit(push.grid, depth) : 0u;
        position[r] = pixel_ray(push.grid, vec2(pixel)) * depth;
        normal[r] = decode_normal(surface.xy);
        toward_eye[r] = normalize(-position[r]);
        base[r] = reflectance.rgb;
        const uint class_ = kRetro != 0u && drawn ? retro_class(reflectance.a) : kRetroClasses;
        sheet[r] = min(class_, kRetroClasses - 1u);
        if (kRetro != 0u) chord2[r] = class_ < kRetroClasses ? retro_chord2(sheet[r]) : -1.0;
        prepare_lobe(r, base[r], reflectance.a >= kRetroCode ? 0.0 : max(reflectance.a, 0.0), surface.w);
        if (kRoads != 0u) roads[r] = road_at(reflectance.a, normal[r], toward_eye[r], push.roads);
        const bool road = kRoads != 0u && roads[r].tan_cells > 0.0;
        least_cosine[r] = surface.w < 1.0 ? 1.0 : 0.0;
        ambient[r] = push.ambient * base[r] * (push.lambert * (road ? road_in_diffuse(-surface.w, dot(normal[r], toward_eye[r])) : 1.0));
        sum[r] = vec3(0.0);
    }

    if (kMerged != 0u) add_merged(block, first);
    if (kListed != 0u) add_lamps_of(block, corner);
    add_directional(block);

    [[unroll]] for (uint r = 0u; r < kRows; ++r) {
        const uvec2 pixel = first + uvec2(0u, r);
        const vec3 reflected = (kShiny ? sum[r] : sum[r] * diffuse[r]) + ambient[r];
        const vec3 emission = min(imageLoad(scene_image, ivec2(pixel)).rgb, vec3(push.emission_limit));
        const vec3 luminance = in_slice[r] == 0u ? push.sky : reflected + emission;
        if (there && all(lessThan(pixel, push.size))) imageStore(scene_image, ivec2(pixel), vec4(luminance, 1.0));
    }
}
