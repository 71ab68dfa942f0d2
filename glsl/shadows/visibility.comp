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
layout(push_constant, scalar) uniform Push { VisibilityPush push; };

#include "lamp.glsl"
#include "lanes.glsl"
#include "shadows/lookup.glsl"

const float kMostSheen = 8.0;  // what a sheen or a wide lobe has, at most, in place of a cosine
const uint kProbes = 16u, kFirstProbes = 4u;
const float kMostTilt = 1e-3, kMostLift = 1e-3;  // of a plane's pixels: rad; and of their distance from the eye
// Of the radius of a lamp: how far aside probes look up, and so the widest radius of a penumbra. It is that of what stops the
// light after a quarter of the way.
const float kWidest = 3.0;

vec3 position[kBlockSize], normal[kBlockSize];  // of the column
bool drawn[kBlockSize];
bool plane;          // all of the block's surfaces are one
bool filled;         // something is drawn at each of its pixels
bool shiny;          // of the block: whether some surface with a specular lobe or road with a table is drawn
float pixel_size;    // m across the way from the eye, where the block is nearest
vec3 probe_position[kProbes], probe_normal[kProbes];  // two in each column and row, and in the corners
bool probe_drawn[kProbes];
// Of lamps.
shared uint listed[kBlockCapacity];      // their entries
shared uint found[kBlockCapacity];       // what their blocks see, see below
shared float brightest[kBlockCapacity];  // the largest illuminance that they give a probe, lx
shared float way[kBlockCapacity];        // how much of the way from the lamp its light gets, where something stops it
shared uint chosen[kBlockCapacity];      // places on the list of lamps that all probes look up
shared uint counted[kBlockSize];         // by columns: see look_up()

void read_block(uvec2 corner) {
    const uint column = gl_LocalInvocationID.x;
    bool shines = false, all_drawn = true;
    float nearest = 1e30;
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        const uvec2 pixel = corner + uvec2(column, r);
        const vec4 surface = imageLoad(surface_image, ivec2(min(pixel, push.size - 1u)));
        drawn[r] = surface.z > 0.0 && all(lessThan(pixel, push.size));
        position[r] = pixel_ray(push.grid, vec2(pixel)) * surface.z;
        normal[r] = decode_normal(surface.xy);
        shines = shines || (drawn[r] && surface.w < 1.0);
        all_drawn = all_drawn && drawn[r];
        nearest = drawn[r] ? min(nearest, surface.z) : nearest;
    }
    shiny = lanes_any(shines);
    filled = lanes_all(all_drawn);
    pixel_size = abs(push.grid.ray_scale.y) * -lanes_max(-nearest);
    // The first four are one in each quarter; the last eight are in the corners and near the middle.
    const uint columns[2] = uint[](0x66215152u, 0x44337700u), rows[2] = uint[](0x14636521u, 0x35427070u);
    [[unroll]] for (uint k = 0u; k < kProbes; ++k) {
        const uvec2 pixel = corner + (uvec2(columns[k / 8u], rows[k / 8u]) >> 4u * (k % 8u) & 7u);
        const vec4 surface = imageLoad(surface_image, ivec2(min(pixel, push.size - 1u)));
        probe_drawn[k] = surface.z > 0.0 && all(lessThan(pixel, push.size));
        probe_position[k] = pixel_ray(push.grid, vec2(pixel)) * surface.z;
        probe_normal[k] = decode_normal(surface.xy);
    }
    bool same = probe_drawn[0];
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        const bool level = abs(dot(probe_normal[0], position[r] - probe_position[0])) <= -kMostLift * probe_position[0].z;
        same = same && (!drawn[r] || (level && distance(normal[r], probe_normal[0]) <= kMostTilt));
    }
    plane = lanes_all(same);
}

const uint kLit = 0u, kDark = kShares + 1u, kMixed = kShares + 2u;  // of `found`; between: sixteenths that are seen

// Whether other pixels may see what the probes do not: of a plane, where these differ.
bool is_open(uint seen) { return !plane || (seen > kLit && seen < kDark); }

// What probes get of a lamp.
struct Sight {
    uint facing, seen;  // probes
    float cosine;       // largest
    float ways;         // sum over those that do not see it, see glances()
};

uint pack(Sight s) { return uint(s.cosine * 255.0) << 16u | s.facing << 8u | s.seen; }  // but for the ways
Sight unpack(uint packed, float ways) { return Sight(packed >> 8u & 0xffu, packed & 0xffu, float(packed >> 16u) / 255.0, ways); }
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
    const bool sees_it = glances(map, beside - to, probe_normal[k], way_here) && faces;
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

// What all pixels see: a share of the lamp for each of the column, four bits; and what the block sees. `stops`: how much of
// the way from the lamp its light gets, where something stops it.
uint look_up(uint index, float stops, out uint word) {
    const FetchedMap map = fetch_map(index);
    const vec3 lamp = texel_at(lamps, int(index * kTexelsPerLamp)).xyz;
    const uint lane = gl_LocalInvocationID.x;
    // The radius of the penumbra, m across the way of the light.
    const float away = distance(lamp, probe_position[0]);
    const float width = min(map.radius * min(1.0 / max(stops, 1e-3) - 1.0, kWidest), 0.5 * away);
    const bool soft = width > max(pixel_size, 2.0 * map.bias * away);
    const bool by_fours = soft && plane && filled && width > 2.0 * pixel_size;
    uint kinds = 0u;  // 1: some pixel does not see all of it; 2: some sees something
    word = 0u;
    if (!soft) {
        [[unroll]] for (uint r = 0u; r < kBlockSize; ++r)
            word |= uint(visibility(map, position[r] - lamp, normal[r]) * 15.0) << 4u * r;
    } else {
        // Each pixel looks up every second point of the disc; in wide penumbrae each of 2 x 2 another quarter of them.
        const uint step = by_fours ? 4u : 2u, lookups = kDisc / step;
        // Rows side by side, so that points of the disc are computed for all of them at once.
        MapPoint points[kBlockSize];
        mat2 steps[kBlockSize];
        uint counts[kBlockSize];
        [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
            const vec3 from = position[r] - lamp;
            points[r] = map_point(map, from, normal[r]);
            steps[r] = width * texels_across(map, from);
            counts[r] = 0u;
        }
        const uint begin = by_fours ? lane & 1u : 0u;
        for (uint k = 0u; k < kDisc; k += step) {
            const vec2 even = disc_point(begin + k), odd = disc_point(begin + k + (by_fours ? 2u : 0u));
            [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
                const vec2 aside = steps[r] * ((r & 1u) == 0u ? even : odd);
                counts[r] += sees(map, points[r], ivec2(floor(points[r].texel + aside))) ? 1u : 0u;
            }
        }
        uint packed = 0u;
        [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
            counts[r] = points[r].inside ? counts[r] : lookups;
            packed |= counts[r] << 4u * r;  // 8 at most, by fours
        }
        counted[lane] = packed;
        lanes_wait();
        const uint beside = counted[lane ^ 1u];
        lanes_wait();
        [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
            const uint four = counts[r] + counts[r ^ 1u] + (beside >> 4u * r & 15u) + (beside >> 4u * (r ^ 1u) & 15u);
            // Rounded in four ways, so that the mean of the four is finer than what four bits hold.
            const uint rounding = ((r & 1u) * 2u + ((lane + r) & 1u)) * (kDisc / 4u) + kDisc / 8u;
            word |= (by_fours ? (four * 15u + rounding) / kDisc : (counts[r] * 15u + lookups / 2u) / lookups) << 4u * r;
        }
    }
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        const uint share = word >> 4u * r & 15u;
        const bool before = drawn[r] && dot(normal[r], position[r] - lamp) < 0.0;
        kinds |= !before ? 0u : (share < 15u ? 1u : 0u) | (share > 0u ? 2u : 0u);
    }
    kinds = lanes_or(kinds);
    return kinds == 3u ? kMixed : kinds == 1u ? kDark : kLit;
}

// Writes what a block sees. Returns how many lamps are lit, dark, mixed, and mixed of little light.
uvec4 see(uint x, uint y) {
    const uint lane = gl_LocalInvocationID.x, block = y * push.blocks_x + x;
    const int counts = int(2u * block), first = int(block * push.capacity), last = first + int(push.capacity) - 1;
    const uint cones = block_counts[counts], all_ = cones + block_counts[counts + 1];
    if (cones == kAllLamps || all_ == 0u) return uvec4(0u);
    read_block(uvec2(x, y) * kBlockSize);

    float light = 0.0;  // the mean of the block is the sum of all invocations, lx
    for (uint i = lane; i < all_; i += kBlockSize) {
        const uint entry = written_texel_at(entries, i < cones ? first + int(i) : last - int(i - cones)).r;
        listed[i] = entry;
        light += probe(i, lamp_of(entry), i < cones);
    }
    // The light that a lamp must give for more probes to look it up: more than the share shadow_error of the block's mean light.
    float limit = max(push.shadow_error * lanes_add(light), 1e-9);
    uint number = 0u;
    for (uint begin = 0u; begin < all_; begin += kBlockSize) {
        const uint i = begin + lane;
        const bool more = i < all_ && (brightest[i] * (shiny ? kMostSheen : 1.0) > limit || unpack(found[i], 0.0).facing == 0u);
        const uint at = number + lanes_add_before(more ? 1u : 0u);
        if (more) chosen[at] = i;
        number += lanes_add(more ? 1u : 0u);
    }
    lanes_wait();
    for (uint c = lane; c < number; c += kBlockSize) {
        const uint i = chosen[c];
        probe_more(i, lamp_of(listed[i]));
    }
    lanes_wait();
    for (uint i = lane; i < all_; i += kBlockSize) {
        const Sight s = unpack(found[i], way[i]);
        found[i] = found_of(s);
        way[i] = s.facing > s.seen ? s.ways / float(s.facing - s.seen) : 1.0;
    }
    // And for all pixels to do so, so much that there are places for all such lamps.
    for (bool fits = false; !fits; limit *= fits ? 1.0 : 2.0) {
        uint matter = 0u;
        for (uint i = lane; i < all_; i += kBlockSize) matter += is_open(found[i]) && brightest[i] > limit ? 1u : 0u;
        fits = lanes_add(matter) <= kSharePlaces;
    }

    uint lit = 0u, dark = 0u, mixed = 0u, kept = 0u;  // kept: cones, and from bit 16 on others
    for (uint begin = 0u; begin < all_; begin += kBlockSize) {
        const uint i = begin + lane;
        const bool there = i < all_, cone = i < cones;
        const uint entry = there ? listed[i] : 0u;
        uint visible = there ? found[i] : kDark, mark = 0u;
        const bool matters = there && is_open(visible) && brightest[i] > limit;
        // Lamps that all pixels look up, one after another.
        uint next = lanes_max(matters ? i + 1u : 0u);
        while (next != 0u) {
            const bool mine = i + 1u == next;
            const uint lamp = lanes_max(mine ? lamp_of(entry) : 0u);
            uint word;
            const float stops = lanes_max(mine ? way[i] : 0.0);
            const uint sees_it = look_up(lamp, stops, word);
            if (sees_it == kMixed)
                write_texel(shares, int((block * kSharePlaces + mixed) * kBlockSize + lane), word);
            visible = mine ? sees_it : visible;
            mark = mine && sees_it == kMixed ? kMixedBit | mixed << kShareShift : mark;
            mixed += sees_it == kMixed ? 1u : 0u;
            next = lanes_max(matters && i + 1u < next ? i + 1u : 0u);
        }
        mark = visible < kShares ? visible << kShareShift : mark;
        const bool stays = visible != kDark;
        const uint one = stays ? (cone ? 1u : 1u << 16u) : 0u, before = kept + lanes_add_before(one);
        if (stays) write_texel(entries, cone ? first + int(before & 0xffffu) : last - int(before >> 16u), entry | mark);
        kept += lanes_add(one);
        lit += visible == kLit ? 1u : 0u;
        dark += there && visible == kDark ? 1u : 0u;
    }
    lit = lanes_add(lit), dark = lanes_add(dark);
    if (lane == 0u) {
        block_counts[counts] = kept & 0xffffu;
        block_counts[counts + 1] = kept >> 16u;
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
