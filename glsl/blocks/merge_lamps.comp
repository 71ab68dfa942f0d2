#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Light merging: adds up the lamps whose illuminance is smooth over a block of pixels (shared/blocks.h), one block per invocation, leaves the
// others on the block's list, and puts the block in its class. Smooth is what the polynomial through 3 x 3 nodes
// meets, within merge_error, at four pixels between them.

#include "blocks.glsl"
#include "normal.glsl"
#include "texels.glsl"
#include "shared/blocks.h"
#include "shared/retro.h"

layout(local_size_x = 8) in;
layout(constant_id = 0) const uint kCones = 1u;   // there are points and spots,
layout(constant_id = 1) const uint kPowers = 1u;  // cosine powers,
layout(constant_id = 2) const uint kTables = 1u;    // measured distributions,
layout(constant_id = 3) const uint kRoads = 1u;   // roads with a table,
layout(constant_id = 4) const uint kMaps = 1u;    // shadow maps of lamps

layout(binding = 0, rgba16f) readonly uniform image2D reflectance_image;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
TEXELS(2, vec4, lamps);
layout(binding = 3, scalar) buffer BlockCounts { uint block_counts[]; };
WRITTEN_TEXELS(4, uint, entries);
layout(binding = 5, scalar) writeonly buffer Sums { vec4 sums[]; };
TEXELS(6, vec4, tables);
layout(binding = 7, scalar) buffer ClassCounts { uint class_counts[]; };
layout(binding = 8, scalar) writeonly buffer ClassBlocks { uint class_blocks[]; };
layout(push_constant, scalar) uniform Push { MergePush push; };

#include "lamp.glsl"
#include "road.glsl"

const uint kNodes = 9u, kPoints = 13u;             // nodes, then the points between
const float kBetween = 5.0 / 7.0;                  // of the way from the middle to an outer node: the next pixel
const float kHalf = 0.5 * float(kBlockSize - 1u);  // px, from the middle of a block to its outer nodes
const float kWidestCone = 0.35;                    // rad
const float kOfCell = 0.5;
const float kMostTilt = 3e-4, kMostLift = 2e-4;    // of a plane's pixels: rad; and of their distance from the eye

bool drawn, paved, glossy, retro;  // whether anything, some road, some specular lobe, some sheet is drawn
bool plane;                        // whether all of it is one plane of one kind that lamps can be added up on;
float tilt, lift;                  // how far its pixels are off that, rad and m
uint slices;                       // that its pixels are in, a bit for each
vec3 normal;
vec3 points[kPoints];              // m
Road roads[kPoints];
float radius;                      // of the points around the middle one, m
vec3 sum[kNodes];                  // see shared/blocks.h
bool lookups;                      // whether pixels look up lamps in shadow maps

// Where a node or point is, from -1 to 1 between the outer nodes.
vec2 unit_of(uint k) {
    if (k < kNodes) return vec2(float(k % 3u), float(k / 3u)) - 1.0;
    return (vec2(float((k - kNodes) % 2u), float((k - kNodes) / 2u)) - 0.5) * (2.0 * kBetween);
}

void look_at_block(uvec2 corner) {
    const uvec2 end = min(corner + kBlockSize, push.size);
    float kind = 0.0, away = 0.0;
    drawn = false, paved = false, glossy = false, retro = false, plane = true, tilt = 0.0, lift = 0.0, slices = 0u;
    for (uint y = corner.y; y < end.y; ++y)
        for (uint x = corner.x; x < end.x; ++x) {
            const vec4 surface = imageLoad(surface_image, ivec2(x, y));
            const float metallic = imageLoad(reflectance_image, ivec2(x, y)).a;
            const bool here = surface.z > 0.0, first = here && !drawn;
            const vec3 n = decode_normal(surface.xy), position = pixel_ray(push.view.grid, vec2(x, y)) * surface.z;
            const bool road = kRoads != 0u && metallic <= kRoadKind;
            drawn = drawn || here;
            paved = paved || (here && road);
            glossy = glossy || (here && !road && (surface.w < 1.0 || metallic > 0.0));
            retro = retro || (here && metallic >= kRetroCode);
            normal = first ? n : normal;
            away = first ? dot(n, position) : away;
            kind = first ? metallic : kind;
            const float tilted = distance(n, normal), lifted = abs(dot(normal, position) - away);
            plane = plane && (!here || (metallic == kind && tilted <= kMostTilt && lifted <= kMostLift * surface.z));
            tilt = here ? max(tilt, tilted) : tilt;
            lift = here ? max(lift, lifted) : lift;
            slices |= slice_bit(push.view.grid, surface.z);
        }
    plane = plane && drawn && !glossy && !retro;
    const vec2 middle = vec2(corner) + kHalf;
    [[unroll]] for (uint k = 0u; k < kPoints; ++k) {
        const vec3 ray = pixel_ray(push.view.grid, middle + kHalf * unit_of(k));
        const float depth = away / dot(normal, ray);
        plane = plane && depth > 0.0 && depth < 1e6;  // a block at the horizon looks past the plane
        points[k] = ray * depth;
        if (kRoads != 0u) roads[k] = road_at(kind, normal, -normalize(points[k]), push.roads);
    }
    radius = 0.0;
    [[unroll]] for (uint k = 0u; k < 4u; ++k) radius = max(radius, distance(points[4], points[2u * (k % 2u) + 6u * (k / 2u)]));
}

// The value of the polynomial at a point between the nodes.
float between(float value[kPoints], uint k) {
    const bool left = unit_of(k).x < 0.0, top = unit_of(k).y < 0.0;
    const float near = 0.5 * kBetween * (1.0 + kBetween), middle = 1.0 - kBetween * kBetween, far = -0.5 * kBetween * (1.0 - kBetween);  // Lagrange
    float row[3];
    [[unroll]] for (uint j = 0u; j < 3u; ++j)
        row[j] = (left ? near : far) * value[3u * j] + middle * value[3u * j + 1u] + (left ? far : near) * value[3u * j + 2u];
    return (top ? near : far) * row[0] + middle * row[1] + (top ? far : near) * row[2];
}

// How wide a cone of directions may be, as an angle from its axis, rad, for the points to show all that is in it: a beam is not narrower than
// that, and a lamp is not so near that its peak fits between them.
float widest_cone(FetchedLamp lamp, bool cone) {
    float beam = kPi;
    if (cone) beam = lamp.lobe_a > 0.0 ? arccos(clamp(-lamp.lobe_b / lamp.lobe_a, -1.0, 1.0)) : kPi;
    if (!cone && kPowers != 0u) beam = inversesqrt(max(lamp.lobe_a, 0.1));  // where cos^n is still exp(-1/2)
    return min(0.5 * beam, kWidestCone);
}

// Nor may points that follow one another along the diagonals be farther apart than a good part of a cell of the table, so that none of its
// nodes hides between.
bool shows_nodes(vec2 at[kPoints]) {
    float apart2 = 0.0;  // in cells
    [[unroll]] for (uint k = 0u; k < 4u; ++k) {
        const vec2 inner = at[kNodes + k] - at[4], outer = at[2u * (k % 2u) + 6u * (k / 2u)] - at[kNodes + k];
        apart2 = max(apart2, max(dot(inner, inner), dot(outer, outer)));
    }
    return apart2 <= kOfCell * kOfCell;
}

// Adds a lamp if it is smooth over the plane: wrong by at most merge_error, or by a quarter of the threshold, below which lamps are left out
// anyway. Such a lamp counts where it gives less than that, too. Returns whether it stays on the list.
bool remains(FetchedLamp lamp, float share, bool cone) {
    float value[kPoints];
    vec2 at[kPoints];
    bool lit = true, none_counts = true, even = true;
    float least = 1e30, nearest = 0.0;  // the inverse of a distance
    [[unroll]] for (uint k = 0u; k < kPoints; ++k) {
        const vec3 to = lamp.position - points[k];
        const float inverse = inversesqrt(max(dot(to, to), 1e-12));
        const float normal_lamp = dot(normal, to) * inverse;
        const float relative = relative_intensity(lamp, -dot(lamp.axis, to) * inverse, -to, inverse, cone, at[k]);
        const float facing = lamp.intensity * relative * (inverse * inverse);  // illuminance facing the lamp, lx
        float weight = normal_lamp;
        if (kRoads != 0u) weight = paved ? road_coefficient(roads[k], to, inverse, normal_lamp) : weight;
        value[k] = facing * weight;
        lit = lit && relative > 0.0 && normal_lamp > 0.0;
        // Where it is dark a beam may still reach in between the points.
        none_counts = none_counts && (normal_lamp <= 0.0 || (relative > 0.0 && 2.0 * facing * (paved ? 1.0 : normal_lamp) < push.view.threshold));
        // Light that grazes sees the least unevenness.
        even = even && 2.0 * (tilt + lift * inverse) <= push.merge_error * normal_lamp;
        least = min(least, value[k]);
        nearest = max(nearest, inverse);
    }
    float error = 0.0;
    [[unroll]] for (uint k = kNodes; k < kPoints; ++k) error = max(error, abs(between(value, k) - value[k]));
    bool resolved = radius * nearest <= widest_cone(lamp, cone);
    if (!cone && kTables != 0u) resolved = resolved && (!lamp.measured || shows_nodes(at));
    const bool taken = resolved && even && lit && error <= max(push.merge_error * least, 0.25 * push.view.threshold);
    [[unroll]] for (uint k = 0u; k < kNodes; ++k) sum[k] += lamp.colour * (taken ? share * value[k] : 0.0);
    return !(taken || (resolved && none_counts));
}

// Whether an entry is for all pixels of the block. A block of many slices lists a lamp several times, for different pixels.
bool covers(uint entry) { return (slices & ~slices_of(entry)) == 0u; }

// Merges lamps of a block. Returns whether any is left on its list.
bool merge_block(uint block) {
    const int counts = int(2u * block), first = int(block * push.capacity), last = first + int(push.capacity) - 1;
    const uint cones = block_counts[counts], others = block_counts[counts + 1];
    lookups = kMaps != 0u && cones == kAllLamps;
    const uint tables_from = push.view.lamps.cones + push.view.lamps.powers;
    if (!plane || cones == kAllLamps || push.merge_error <= 0.0) return cones + others != 0u || push.merge_error <= 0.0;
    int kept_cones = 0, kept_others = 0;
    if (kCones != 0u)
        for (int i = 0; i < int(cones); ++i) {
            const uint entry = written_texel_at(entries, first + i).r;
            if (covers(entry) && (entry & kMixedBit) == 0u && !remains(fetch(lamp_of(entry), true, tables_from), share_of(entry), true)) continue;
            write_texel(entries, first + kept_cones, entry);
            ++kept_cones;
        }
    if (kPowers != 0u || kTables != 0u)
        for (int i = 0; i < int(others); ++i) {
            const uint entry = written_texel_at(entries, last - i).r;
            if (covers(entry) && (entry & kMixedBit) == 0u && !remains(fetch(lamp_of(entry), false, tables_from), share_of(entry), false)) continue;
            write_texel(entries, last - kept_others, entry);
            ++kept_others;
        }
    block_counts[counts] = uint(kept_cones);
    block_counts[counts + 1] = uint(kept_others);
    return kept_cones + kept_others != 0;
}

uint class_of(bool listed) {
    if (!drawn) return kClassEmpty;
    if (retro || lookups) return kClassRetro;
    if (glossy) return paved ? kClassGlossyPaved : kClassGlossy;
    if (paved) return listed ? kClassPavedListed : kClassPaved;
    return listed ? kClassMattListed : kClassMatt;
}

void main() {
    // A CPU device gives each thread half of the workgroups: every other row of blocks, so that both get sky and road.
    const uint even_rows = (push.blocks_y + 1u) / 2u, turn = gl_WorkGroupID.y;
    const uint y = turn < even_rows ? 2u * turn : 2u * (turn - even_rows) + 1u, x = gl_GlobalInvocationID.x;
    if (x >= push.blocks_x) return;
    const uint block = y * push.blocks_x + x;
    [[unroll]] for (uint k = 0u; k < kNodes; ++k) sum[k] = vec3(0.0);
    look_at_block(uvec2(x, y) * kBlockSize);
    const uint class_ = class_of(merge_block(block));

    const uint place = atomicAdd(class_counts[class_ * kClassWords + 3u], 1u);
    if (place % kBlocksPerGroup == 0u) atomicAdd(class_counts[class_ * kClassWords], 1u);
    class_blocks[class_ * push.blocks_x * push.blocks_y + place] = block;
    const int at = int(block * kMergedTexels);
    sums[at] = vec4(sum[0], sum[1].r);
    sums[at + 1] = vec4(sum[1].gb, sum[2].rg);
    sums[at + 2] = vec4(sum[2].b, sum[3]);
    sums[at + 3] = vec4(sum[4], sum[5].r);
    sums[at + 4] = vec4(sum[5].gb, sum[6].rg);
    sums[at + 5] = vec4(sum[6].b, sum[7]);
    sums[at + 6] = vec4(sum[8], 0.0);
}
