#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require

// Visibility of lamps from blocks of pixels: one block per workgroup. Some pixels of the block, the probes, look up each lamp
// on its list in its shadow map, one lamp per invocation: four of them, and sixteen for a lamp that gives a good part of the
// block's light. Where these differ, or the block is no plane, all pixels do: one column of them per invocation. Lamps that no
// pixel of the block sees leave its list.
// CPU drivers go through what a branch leaves out, with all invocations masked, and leave a loop at the end of its body alone.
// So loops test there, and hard edges and penumbrae are looked up in loops of their own.

#include "blocks.glsl"
#include "normal.glsl"
#include "texels.glsl"
#include "shared/visibility.h"

layout(local_size_x = 8) in;  // kBlockSize
layout(constant_id = 0) const uint kPowers = 1u;  // there are cosine powers,
layout(constant_id = 1) const uint kTables = 1u;  // measured distributions
layout(constant_id = 2) const uint kLockstep = 0u;  // see lanes.glsl

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
TEXELS(1, vec4, lamps);
layout(binding = 2, scalar) buffer BlockCounts { uint block_counts[]; };
WRITTEN_TEXELS(3, uint, entries);
TEXELS(4, vec4, maps);
HALVES(5, distances);
TEXELS(6, vec4, tables);
writeonly WRITTEN_TEXELS(7, uint, shares);
layout(binding = 8, scalar) buffer Report { uint report[]; };
layout(binding = 9, r32ui) readonly uniform uimage2D slope_image;
layout(push_constant, scalar) uniform Push { VisibilityPush push; };

#include "lamp.glsl"
#include "lanes.glsl"
#include "shadows/lookup.glsl"
#include "shadows/edge_lines.glsl"

const float kMostSheen = 8.0;  // what a sheen or a wide lobe has, at most, in place of a cosine
const uint kProbes = 16u, kFirstProbes = 4u, kCornerProbes = 8u, kMiddleProbe = 13u;
const float kLeastIncidence = 0.1;  // cosine; where light grazes, a step of 1 cm in a plane moves edges by decimetres
const float kMostTilt = 1e-3, kMostLift = 1e-3;  // of a plane's pixels: rad; and of their distance from the eye
// Of the radius of a lamp: how far aside probes look up, and so the widest radius of a penumbra. It is that of what stops the
// light after a quarter of the way.
const float kWidest = 3.0;

vec3 position[kBlockSize], normal[kBlockSize];  // of the column
bool relief[kBlockSize];
vec3 facet_normal[kBlockSize];  // of the planes of its triangles, which maps are compared with
bool drawn[kBlockSize];
bool plane;          // all of the block's surfaces are one
bool filled;         // something is drawn at each of its pixels
bool shiny;          // of the block: whether some surface with a specular lobe or road with a table is drawn
float pixel_size;    // m across the way from the eye, where the block is nearest
bool probe_relief[kProbes];
vec3 probe_position[kProbes], probe_normal[kProbes], probe_facet[kProbes];  // two in each column and row, and in the corners
bool probe_drawn[kProbes];
// Of lamps.
shared uint listed[kBlockCapacity];      // their entries
shared uint found[kBlockCapacity];       // what their blocks see, see below
shared float brightest[kBlockCapacity];  // the largest illuminance that they give a probe, lx
shared float way[kBlockCapacity];        // what Sight::ways holds
shared uint chosen[kBlockCapacity];      // places on the list of lamps that all probes, and then all pixels, look up
shared float widths[kSharePlaces];       // of the penumbrae of those that are looked up
shared uint counted[kBlockSize];         // by columns: see look_up_penumbra()
shared uint coarse[kSharePlaces];        // as chosen: those with hard edges and wide texels

void read_block(uvec2 corner) {
    const uint column = gl_LocalInvocationID.x;
    bool shines = false, all_drawn = true;
    float nearest = 1e30;
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        const uvec2 pixel = corner + uvec2(column, r);
        const ivec2 at = ivec2(min(pixel, push.size - 1u));
        const vec4 surface = imageLoad(surface_image, at);
        const vec3 ray = pixel_ray(push.grid, vec2(pixel));
        drawn[r] = surface.z > 0.0 && all(lessThan(pixel, push.size));
        position[r] = ray * surface.z;
        normal[r] = decode_normal(surface.xy);
        relief[r] = is_relief(surface.xy);
        facet_normal[r] = plane_normal(imageLoad(slope_image, at).r, ray, push.grid.ray_scale, normal[r]);
        shines = shines || (drawn[r] && surface.w < 1.0);
        all_drawn = all_drawn && drawn[r];
        nearest = drawn[r] ? min(nearest, surface.z) : nearest;
    }
    pixel_size = abs(push.grid.ray_scale.y) * -lanes_max(-nearest);
    // The first four are one in each quarter; the last eight are in the corners and near the middle.
    const uint columns[2] = uint[](0x66215152u, 0x44337700u), rows[2] = uint[](0x14636521u, 0x35427070u);
    [[unroll]] for (uint k = 0u; k < kProbes; ++k) {
        const uvec2 pixel = corner + (uvec2(columns[k / 8u], rows[k / 8u]) >> 4u * (k % 8u) & 7u);
        const ivec2 at = ivec2(min(pixel, push.size - 1u));
        const vec4 surface = imageLoad(surface_image, at);
        const vec3 ray = pixel_ray(push.grid, vec2(pixel));
        probe_drawn[k] = surface.z > 0.0 && all(lessThan(pixel, push.size));
        probe_position[k] = ray * surface.z;
        probe_normal[k] = decode_normal(surface.xy);
        probe_relief[k] = is_relief(surface.xy);
        probe_facet[k] = plane_normal(imageLoad(slope_image, at).r, ray, push.grid.ray_scale, probe_normal[k]);
    }
    bool same = probe_drawn[0];
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        const bool level = abs(dot(probe_normal[0], position[r] - probe_position[0])) <= -kMostLift * probe_position[0].z;
        same = same && (!drawn[r] || (level && distance(normal[r], probe_normal[0]) <= kMostTilt));
    }
    const uint flags = lanes_or((shines ? 1u : 0u) | (all_drawn ? 0u : 2u) | (same ? 0u : 4u));
    shiny = (flags & 1u) != 0u;
    filled = (flags & 2u) == 0u;
    plane = (flags & 4u) == 0u;
}

const uint kLit = 0u, kDark = kShares + 1u, kMixed = kShares + 2u;  // what a block sees; between: sixteenths that are seen
// Of `found`, which holds a Sight: all pixels looked up the lamp. It holds what they see, and from bit 8 on the place of shares.
const uint kLookedUp = 1u << 31u;

// Whether other pixels may see what the probes do not: where these differ, and where the block is no plane and the lamp not faint.
bool is_open(uint seen, bool faint) { return !(plane || faint) || (seen > kLit && seen < kDark); }

// What probes get of a lamp.
struct Sight {
    uint facing, seen;  // probes
    float cosine;       // largest
    float ways;         // sum over those that do not see it, see glances()
};

// The normal of the plane that a map is compared with: of a triangle, or, where that faces away from the lamp, the interpolated one.
// A relief sees no lamp that its plane turns away from: its normals would light it through itself.
bool turns_away(bool relief, vec3 facet, vec3 to_lamp) { return relief && dot(facet, to_lamp) <= 0.0; }

vec3 compared(vec3 facet, vec3 interpolated, vec3 to_lamp) { return dot(facet, to_lamp) > 0.0 ? facet : interpolated; }

uint pack(Sight s) { return uint(s.cosine * 255.0) << 16u | s.facing << 8u | s.seen; }  // but for the ways
Sight unpack(uint packed, float ways) { return Sight(packed >> 8u & 0xffu, packed & 0xffu, float(packed >> 16u) / 255.0, ways); }
// Sight of the block, by its probes.
uint found_of(Sight s) {
    if (s.seen == 0u) return kDark;
    return s.seen == s.facing ? kLit : clamp((kShares * s.seen + s.facing / 2u) / s.facing, 1u, kShares - 1u);
}

// Looks up a lamp from a probe, or from beside it. Returns the cosine of incidence, 0 where it does not see the lamp.
float probe_from(uint k, vec3 beside, FetchedMap map, vec3 lamp, inout Sight s, out vec3 to, out float inverse) {
    to = lamp - probe_position[k];
    inverse = inversesqrt(max(dot(to, to), 1e-12));
    const float cosine = dot(probe_normal[k], to) * inverse;
    const bool faces = probe_drawn[k] && cosine > 0.0;
    float way_here;
    const bool sees_it = glances(map, beside - to, compared(probe_facet[k], probe_normal[k], to), way_here) && faces &&
                         !turns_away(probe_relief[k], probe_facet[k], to);
    s.facing += faces ? 1u : 0u;
    s.seen += sees_it ? 1u : 0u;
    s.ways += faces && !sees_it ? way_here : 0.0;
    s.cosine = max(s.cosine, faces ? cosine : 0.0);
    return sees_it ? cosine : 0.0;
}

// The first probes look up a lamp, one for each invocation. Returns their mean illuminance by it, lx.
float probe(uint number, uint index, bool cone) {
    const FetchedMap map = fetch_map(index);
    const FetchedLamp lamp = fetch(index, cone, push.lamps.cones + push.lamps.powers);
    Sight s = Sight(0u, 0u, 0.0, 0.0);
    float sum = 0.0, beam = 0.0, valid = 0.0;
    [[unroll]] for (uint k = 0u; k < kFirstProbes; ++k) {
        vec3 to;
        float inverse;
        const float cosine = probe_from(k, vec3(0.0), map, lamp.position, s, to, inverse);
        const float here = lamp.intensity * relative_intensity(lamp, -dot(lamp.axis, to) * inverse, -to, inverse, cone) * inverse * inverse;
        sum += here * cosine;
        beam = max(beam, probe_drawn[k] ? here : 0.0);
        valid += probe_drawn[k] ? 1.0 : 0.0;
    }
    found[number] = pack(s);
    brightest[number] = plane && !shiny ? beam * s.cosine : beam;
    way[number] = s.ways;
    return sum / max(valid, 1.0);
}

// So do the others, half of them from where the light of an edge of the lamp's disc ends.
void probe_more(uint number, uint index) {
    const FetchedMap map = fetch_map(index);
    const vec3 lamp = texel_at(lamps, int(index * kTexelsPerLamp)).xyz;
    const vec3 to_lamp = lamp - probe_position[0];
    const float away = length(to_lamp);
    const vec3 l = to_lamp / max(away, 1e-6), n = probe_normal[0];
    const float reach = plane ? min(kWidest * map.radius, 0.5 * away) : 0.0;
    const vec3 a = across(l), b = cross(l, a);
    const float slant = reach / max(dot(n, l), 0.1);  // along the plane, by the way of the light
    const vec3 along_a = reach * a - slant * dot(n, a) * l, along_b = reach * b - slant * dot(n, b) * l;
    Sight s = unpack(found[number], way[number]);
    [[unroll]] for (uint k = kFirstProbes; k < kProbes; ++k) {
        const vec2 aside[8] = vec2[](vec2(0.12, 0.00), vec2(-0.18, 0.17), vec2(0.03, -0.37), vec2(0.30, 0.40),
                                     vec2(-0.62, -0.11), vec2(0.63, -0.40), vec2(-0.23, 0.85), vec2(-0.46, -0.89));
        const vec3 beside = k < 8u ? vec3(0.0) : aside[k & 7u].x * along_a + aside[k & 7u].y * along_b;
        vec3 to;
        float inverse;
        probe_from(k, beside, map, lamp, s, to, inverse);
    }
    found[number] = pack(s);
    if (shiny || !plane) brightest[number] *= shiny && s.facing > 0u ? kMostSheen : s.cosine;
    way[number] = s.ways;
}

// The radius of the penumbra of a lamp, m across the way of the light; 0 where edges are hard. `stops`: how much of the way
// from the lamp its light gets, where something stops it.
float penumbra(FetchedMap map, vec3 lamp, float stops) {
    const float away = distance(lamp, probe_position[0]);
    const float width = min(map.radius * min(1.0 / max(stops, 1e-3) - 1.0, kWidest), 0.5 * away);
    return width > max(pixel_size, 2.0 * map.bias * away) ? width : 0.0;
}

// The plane of the middle of the block, compared with a lamp's map.
vec3 middle_normal(vec3 lamp) { return compared(probe_facet[kMiddleProbe], probe_normal[kMiddleProbe], lamp - probe_position[kMiddleProbe]); }

// Whether texels of a lamp's map are wider than two pixels, and the block is one plane whose texels a window holds.
bool has_wide_texels(FetchedMap map, vec3 lamp) {
    const vec3 middle = probe_position[kMiddleProbe], n = middle_normal(lamp);
    const mat2 per_pixel = texels_per_pixel(map, middle - lamp, middle, n, push.grid.ray_scale);
    const MapPoint p = map_point(map, middle - lamp, n);
    const float most_lift = 0.5 * (kMapBias + map.bias * p.norm);
    const vec3 to = lamp - middle;
    bool same = plane && probe_drawn[kMiddleProbe] && p.inside && dot(n, to) > kLeastIncidence * length(to);
    [[unroll]] for (uint k = kCornerProbes; k < kCornerProbes + 4u; ++k) {
        const MapPoint corner = map_point(map, probe_position[k] - lamp, n);
        const bool near = corner.first == p.first && corner.inside && all(lessThan(abs(corner.texel - p.texel), vec2(5.4)));
        same = same && (!probe_drawn[k] || (near && abs(dot(n, probe_position[k] - middle)) < most_lift));
    }
    return same && min(dot(per_pixel[0], per_pixel[0]), dot(per_pixel[1], per_pixel[1])) < 0.25;
}

// Shares of a lamp with hard edges that the pixels of the column see, four bits each.
uint look_up_edges(uint index) {
    const FetchedMap map = fetch_map(index);
    const vec3 lamp = texel_at(lamps, int(index * kTexelsPerLamp)).xyz;
    // Within a column about the same.
    const uint middle = kBlockSize / 2u;
    const mat2 per_pixel = texels_per_pixel(map, position[middle] - lamp, position[middle], facet_normal[middle], push.grid.ray_scale);
    uint word = 0u;
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        const vec3 to_lamp = lamp - position[r];
        const float share = visibility(map, -to_lamp, compared(facet_normal[r], normal[r], to_lamp), per_pixel);
        word |= (turns_away(relief[r], facet_normal[r], to_lamp) ? 0u : uint(share * 15.0 + 0.5)) << 4u * r;
    }
    return word;
}

// The same where texels are wide, see has_wide_texels().
uint look_up_lines(uint index) {
    const FetchedMap map = fetch_map(index);
    const vec3 lamp = texel_at(lamps, int(index * kTexelsPerLamp)).xyz;
    const vec3 middle = probe_position[kMiddleProbe], n = middle_normal(lamp);
    const MapPoint p = map_point(map, middle - lamp, n);
    const ivec2 first = ivec2(floor(p.texel)) - kWindow / 2;
    fill_window(map, map_plane(map, p, middle - lamp, n), first);
    const mat2 per_pixel = texels_per_pixel(map, middle - lamp, middle, n, push.grid.ray_scale);
    uint word = 0u;
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r)
        word |= uint(visibility_by_lines(map, map_point(map, position[r] - lamp, n), per_pixel, first) * 15.0 + 0.5) << 4u * r;
    return word;
}

// The same of one with penumbrae of this radius.
uint look_up_penumbra(uint index, float width) {
    const FetchedMap map = fetch_map(index);
    const vec3 lamp = texel_at(lamps, int(index * kTexelsPerLamp)).xyz;
    const uint lane = gl_LocalInvocationID.x;
    const bool by_fours = plane && filled && width > 2.0 * pixel_size;
    // Each pixel looks up every second point of the disc; in wide penumbrae each of 2 x 2 another quarter of them.
    const uint step = by_fours ? 4u : 2u, lookups = kDisc / step;
    // Rows side by side, so that points of the disc are computed for all of them at once.
    MapPoint points[kBlockSize];
    mat2 steps[kBlockSize];
    uint counts[kBlockSize];
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        const vec3 from = position[r] - lamp;
        points[r] = map_point(map, from, compared(facet_normal[r], normal[r], -from));
        steps[r] = width * texels_across(map, from);
        counts[r] = 0u;
    }
    const uint begin = by_fours ? lane & 1u : 0u;
    uint k = 0u;
    do {
        const vec2 even = disc_point(begin + k), odd = disc_point(begin + k + (by_fours ? 2u : 0u));
        [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
            const vec2 aside = steps[r] * ((r & 1u) == 0u ? even : odd);
            counts[r] += sees(map, points[r], ivec2(floor(points[r].texel + aside))) ? 1u : 0u;
        }
        k += step;
    } while (k < kDisc);
    uint packed = 0u;
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        counts[r] = points[r].inside ? counts[r] : lookups;
        counts[r] = turns_away(relief[r], facet_normal[r], lamp - position[r]) ? 0u : counts[r];
        packed |= counts[r] << 4u * r;  // 8 at most, by fours
    }
    counted[lane] = packed;
    lanes_wait();
    const uint beside = counted[lane ^ 1u];
    lanes_wait();
    uint word = 0u;
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        const uint four = counts[r] + counts[r ^ 1u] + (beside >> 4u * r & 15u) + (beside >> 4u * (r ^ 1u) & 15u);
        // Rounded in four ways, so that the mean of the four is finer than what four bits hold.
        const uint rounding = ((r & 1u) * 2u + ((lane + r) & 1u)) * (kDisc / 4u) + kDisc / 8u;
        word |= (by_fours ? (four * 15u + rounding) / kDisc : (counts[r] * 15u + 8u) / 16u) << 4u * r;  // 16 lookups
    }
    return word;
}

// Sight of the block, by that of its pixels.
uint found_by_all(uint index, uint word) {
    const vec3 lamp = texel_at(lamps, int(index * kTexelsPerLamp)).xyz;
    uint kinds = 0u;  // 1: some pixel does not see all of it; 2: some sees something
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        const uint share = word >> 4u * r & 15u;
        const bool before = drawn[r] && dot(normal[r], position[r] - lamp) < 0.0;
        kinds |= !before ? 0u : (share < 15u ? 1u : 0u) | (share > 0u ? 2u : 0u);
    }
    kinds = lanes_or(kinds);
    return kinds == 3u ? kMixed : kinds == 1u ? kDark : kLit;
}

// Leaves what all pixels see of a lamp at its place on the list, and their shares. Returns how many are mixed, with this one.
uint leave(uint i, uint index, uint word, uint places, uint mixed) {
    const uint sees_it = found_by_all(index, word);
    if (sees_it == kMixed) write_texel(shares, int((places + mixed) * kBlockSize + gl_LocalInvocationID.x), word);
    if (gl_LocalInvocationID.x == 0u) found[i] = kLookedUp | mixed << 8u | sees_it;
    return mixed + (sees_it == kMixed ? 1u : 0u);
}

// Writes what a block sees. Returns how many lamps are lit, dark, mixed, and mixed of little light.
uvec4 see(uint x, uint y) {
    const uint lane = gl_LocalInvocationID.x, before = (1u << lane) - 1u, block = y * push.blocks_x + x;
    const int counts = int(2u * block), first = int(block * push.capacity), last = first + int(push.capacity) - 1;
    const uint cones = block_counts[counts], all_ = cones + block_counts[counts + 1];
    if (cones == kAllLamps || all_ == 0u) return uvec4(0u);
    read_block(uvec2(x, y) * kBlockSize);

    float light = 0.0;  // the mean of the block is the sum of all invocations, lx
    uint begin = 0u;
    do {
        const uint i = begin + lane;
        if (i < all_) {
            const uint entry = written_texel_at(entries, i < cones ? first + int(i) : last - int(i - cones)).r;
            listed[i] = entry;
            light += probe(i, lamp_of(entry), i < cones);
        }
        begin += kBlockSize;
    } while (begin < all_);
    // The light that a lamp must give for more probes to look it up: more than the share shadow_error of the block's mean light.
    const float light_of_all = lanes_add(light), faint = push.probe_error * light_of_all;
    float limit = max(push.shadow_error * light_of_all, 1e-9);
    uint number = 0u;
    begin = 0u;
    do {
        const uint i = begin + lane;
        const bool more = i < all_ && (brightest[i] * (shiny ? kMostSheen : 1.0) > limit || unpack(found[i], 0.0).facing == 0u);
        const uint those = lanes_mask(more);
        if (more) chosen[number + bitCount(those & before)] = i;
        number += bitCount(those);
        begin += kBlockSize;
    } while (begin < all_);
    lanes_wait();
    uint c = 0u;
    if (number != 0u) do {
        if (c + lane < number) {
            const uint i = chosen[c + lane];
            probe_more(i, lamp_of(listed[i]));
        }
        c += kBlockSize;
    } while (c < number);
    lanes_wait();
    // And for all pixels to do so, so much that there are places for all such lamps.
    uint open = 0u;
    do {
        open = 0u;
        begin = 0u;
        do {
            const uint i = begin + lane;
            const bool matters = i < all_ && brightest[i] > limit && is_open(found_of(unpack(found[i], 0.0)), brightest[i] < faint);
            const uint those = lanes_mask(matters);
            if (matters) chosen[open + bitCount(those & before)] = i;
            open += bitCount(those);
            begin += kBlockSize;
        } while (begin < all_);
        limit *= 2.0;  // for the next time
    } while (open > kSharePlaces);
    lanes_wait();
    // These, one after another: first, from the front of `chosen`, those with hard edges; then, from its end, those with
    // penumbrae; then those in `coarse`.
    uint hard = 0u, soft = 0u, wide = 0u;
    c = 0u;
    if (open != 0u) do {
        const bool there = c + lane < open;
        const uint i = there ? chosen[c + lane] : 0u;
        const Sight s = unpack(found[i], way[i]);
        const uint index = lamp_of(listed[i]);
        const FetchedMap map = fetch_map(index);
        const vec3 lamp = texel_at(lamps, int(index * kTexelsPerLamp)).xyz;
        const float width = penumbra(map, lamp, s.facing > s.seen ? s.ways / float(s.facing - s.seen) : 1.0);
        const bool lines = width == 0.0 && has_wide_texels(map, lamp);
        const uint those = lanes_mask(there && width == 0.0 && !lines), others = lanes_mask(there && width > 0.0);
        const uint of_lines = lanes_mask(there && lines);
        lanes_wait();
        if (there && lines) coarse[wide + bitCount(of_lines & before)] = i;
        if (there && !lines) {
            const uint at = width > 0.0 ? soft + bitCount(others & before) : hard + bitCount(those & before);
            if (width > 0.0) widths[at] = width;
            chosen[width > 0.0 ? kBlockCapacity - 1u - at : at] = i;
        }
        wide += bitCount(of_lines);
        hard += bitCount(those);
        soft += bitCount(others);
        c += kBlockSize;
    } while (c < open);
    lanes_wait();
    const uint places = block * kSharePlaces;
    uint mixed = 0u;
    c = 0u;
    if (hard != 0u) do {
        const uint i = chosen[c], index = lamp_of(listed[i]);
        mixed = leave(i, index, look_up_edges(index), places, mixed);
        ++c;
    } while (c < hard);
    c = 0u;
    if (soft != 0u) do {
        const uint i = chosen[kBlockCapacity - 1u - c], index = lamp_of(listed[i]);
        mixed = leave(i, index, look_up_penumbra(index, widths[c]), places, mixed);
        ++c;
    } while (c < soft);
    c = 0u;
    if (wide != 0u) do {
        const uint i = coarse[c], index = lamp_of(listed[i]);
        mixed = leave(i, index, look_up_lines(index), places, mixed);
        ++c;
    } while (c < wide);
    lanes_wait();

    uint lit = 0u, dark = 0u, kept_cones = 0u, kept_others = 0u;
    begin = 0u;
    do {
        const uint i = begin + lane;
        const bool there = i < all_, cone = i < cones;
        const uint packed = there ? found[i] : 0u;
        const bool looked_up = (packed & kLookedUp) != 0u;
        const uint visible = !there ? kDark : looked_up ? packed & 0xffu : found_of(unpack(packed, 0.0));
        const uint mark = visible < kShares ? visible << kShareShift : visible == kMixed ? kMixedBit | (packed >> 8u & 0xffu) << kShareShift : 0u;
        const bool stays = visible != kDark;
        const uint those = lanes_mask(stays), cone_lanes = (1u << clamp(int(cones) - int(begin), 0, int(kBlockSize))) - 1u;
        const uint earlier = bitCount(those & before & (cone ? cone_lanes : ~cone_lanes));
        if (stays) write_texel(entries, cone ? first + int(kept_cones + earlier) : last - int(kept_others + earlier), listed[i] | mark);
        kept_cones += bitCount(those & cone_lanes);
        kept_others += bitCount(those & ~cone_lanes);
        lit += visible == kLit ? 1u : 0u;
        dark += there && visible == kDark ? 1u : 0u;
        begin += kBlockSize;
    } while (begin < all_);
    lit = lanes_add(lit), dark = lanes_add(dark);
    if (lane == 0u) {
        block_counts[counts] = kept_cones;
        block_counts[counts + 1] = kept_others;
    }
    return uvec4(lit, dark, mixed, all_ - lit - dark - mixed);
}

void main() {
    const uint even_rows = (push.blocks_y + 1u) / 2u, turn = gl_WorkGroupID.y;  // as in merge_lamps
    const uint y = turn < even_rows ? 2u * turn : 2u * (turn - even_rows) + 1u;
    const uvec4 pairs = see(gl_WorkGroupID.x, y);
    if (gl_LocalInvocationID.x != 0u) return;
    [[unroll]] for (int k = 0; k < 4; ++k) atomicAdd(report[k], pairs[k]);
}
