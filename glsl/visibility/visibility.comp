#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require

// Visibility of lamps from blocks of pixels: one block per workgroup, which is one subgroup. Sixteen pixels of the block,
// the probes, tell what it sees of each lamp on its list: one lamp per invocation. Where they differ, or the block is no
// plane, and the lamp gives a good part of its light, all pixels look: one column of them per invocation. Lamps that nothing of the block
// sees leave its list.

#include "blocks.glsl"
#include "normal.glsl"
#include "shared/visibility.h"

layout(local_size_x = 8) in;  // kBlockSize
layout(constant_id = 0) const uint kPowers = 1u;  // there are cosine powers,
layout(constant_id = 1) const uint kTables = 1u;  // measured distributions

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
layout(binding = 1) uniform samplerBuffer lamps;
layout(binding = 2, r32ui) uniform uimageBuffer block_counts;
layout(binding = 3, r32ui) uniform uimageBuffer entries;
layout(binding = 4) uniform samplerBuffer maps;
layout(binding = 5) uniform samplerBuffer distances;
layout(binding = 6) uniform samplerBuffer tables;
layout(binding = 7, r32ui) writeonly uniform uimageBuffer shares;
layout(binding = 8, r32ui) uniform uimageBuffer report;
layout(push_constant, scalar) uniform Push { VisibilityPush push; };

#include "lamp.glsl"
#include "visibility.glsl"

const float kMostSheen = 8.0;  // what a sheen or a wide lobe has, at most, in place of a cosine
const uint kProbes = 16u;
const float kMostTilt = 1e-3, kMostLift = 1e-3;  // of a plane's pixels: rad; and of their distance from the eye

vec3 position[kBlockSize], normal[kBlockSize];  // of the column
bool drawn[kBlockSize];
bool plane;          // all of the block's surfaces are one
bool shiny;          // of the block: whether some surface with a specular lobe or road with a table is drawn
vec3 probe_position[kProbes], probe_normal[kProbes];  // two in each column and row, and in the corners
bool probe_drawn[kProbes];
shared uint found[kBlockCapacity];       // of lamps: what their blocks see, see below; each is its invocation's own
shared float brightest[kBlockCapacity];  // the largest illuminance that they give a probe, lx

void look_at_block(uvec2 corner) {
    const uint column = gl_LocalInvocationID.x;
    bool shines = false;
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        const uvec2 pixel = corner + uvec2(column, r);
        const vec4 surface = imageLoad(surface_image, ivec2(min(pixel, push.size - 1u)));
        drawn[r] = surface.z > 0.0 && all(lessThan(pixel, push.size));
        position[r] = pixel_ray(push.grid, vec2(pixel)) * surface.z;
        normal[r] = decode_normal(surface.xy);
        shines = shines || (drawn[r] && surface.w < 1.0);
    }
    shiny = subgroupAny(shines);
    [[unroll]] for (uint k = 0u; k < kProbes; ++k) {
        const uvec2 pixel = corner + uvec2(k / 2u, ((k % 2u == 0u ? 0x04652130u : 0x71234657u) >> 4u * (k / 2u)) & 7u);
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
    plane = subgroupAll(same);
}

const uint kLit = 0u, kDark = kShares + 1u, kMixed = kShares + 2u;  // of `found`; between: sixteenths that are seen

// Whether other pixels may see what the probes do not: of a plane, where these differ.
bool is_open(uint seen) { return !plane || (seen > kLit && seen < kDark); }

// Looks from the probes at one lamp for each invocation. Returns the mean of what they get of it, lx.
float probe(uint number, uint index, bool cone) {
    const FetchedMap map = fetch_map(index);
    const FetchedLamp lamp = fetch(index, cone, push.lamps.cones + push.lamps.powers);
    uint seen = 0u, before = 0u, valid = 0u;
    float sum = 0.0, beam = 0.0, cosine = 0.0;
    [[unroll]] for (uint k = 0u; k < kProbes; ++k) {
        const vec3 to = lamp.position - probe_position[k];
        const float inverse = inversesqrt(max(dot(to, to), 1e-12)), cosine_here = dot(probe_normal[k], to) * inverse;
        const bool lights = probe_drawn[k] && cosine_here > 0.0;
        const bool sees_it = lights && glances(map, -to, probe_normal[k]);
        seen += sees_it ? 1u : 0u;
        before += lights ? 1u : 0u;
        cosine = max(cosine, lights ? cosine_here : 0.0);
        if (k % 4u == 0u) {  // light changes slowly
            const float here = lamp.intensity * relative_intensity(lamp, -dot(lamp.axis, to) * inverse, -to, inverse, cone) * inverse * inverse;
            sum += sees_it ? here * cosine_here : 0.0;
            beam = max(beam, probe_drawn[k] ? here : 0.0);
            valid += probe_drawn[k] ? 1u : 0u;
        }
    }
    found[number] = seen == 0u ? kDark : seen == before ? kLit : clamp((kShares * seen + before / 2u) / before, 1u, kShares - 1u);
    brightest[number] = beam * (shiny && before > 0u ? kMostSheen : cosine);
    return sum / float(max(valid, 1u));
}

// What all pixels see: a share of the lamp for each of the column, four bits; and what the block sees.
uint look(uint index, out uint word) {
    const FetchedMap map = fetch_map(index);
    const vec3 lamp = texelFetch(lamps, int(index * kTexelsPerLamp)).xyz;
    uint kinds = 0u;  // 1: some pixel does not see all of it; 2: some sees something
    word = 0u;
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        const vec3 from = position[r] - lamp;
        const uint share = uint(visibility(map, from, normal[r]) * 15.0 + 0.5);
        const bool before = drawn[r] && dot(normal[r], from) < 0.0;
        kinds |= !before ? 0u : (share < 15u ? 1u : 0u) | (share > 0u ? 2u : 0u);
        word |= share << 4u * r;
    }
    kinds = subgroupOr(kinds);
    return kinds == 3u ? kMixed : kinds == 1u ? kDark : kLit;
}

void main() {
    const uint even_rows = (push.blocks_y + 1u) / 2u, turn = gl_WorkGroupID.y;  // as in merge_lamps
    const uint y = turn < even_rows ? 2u * turn : 2u * (turn - even_rows) + 1u, x = gl_WorkGroupID.x, lane = gl_LocalInvocationID.x;
    const uint block = y * push.blocks_x + x;
    const int counts = int(2u * block), first = int(block * push.capacity), last = first + int(push.capacity) - 1;
    const uint cones = imageLoad(block_counts, counts).r, all_ = cones + imageLoad(block_counts, counts + 1).r;
    if (cones == kAllLamps || all_ == 0u) return;
    look_at_block(uvec2(x, y) * kBlockSize);

    float light = 0.0;  // the mean of the block is the sum of all invocations, lx
    for (uint i = lane; i < all_; i += kBlockSize) {
        const uint entry = imageLoad(entries, i < cones ? first + int(i) : last - int(i - cones)).r;
        light += probe(i, lamp_of(entry), i < cones);
    }
    // What a lamp must give for all pixels to look at it: more than the faint share of the block's mean light, and so much
    // that there are places for all such lamps.
    float limit = max(push.faint * subgroupAdd(light), 1e-9);
    for (bool fits = false; !fits; limit *= fits ? 1.0 : 2.0) {
        uint matter = 0u;
        for (uint i = lane; i < all_; i += kBlockSize) matter += is_open(found[i]) && brightest[i] > limit ? 1u : 0u;
        fits = subgroupAdd(matter) <= kSharePlaces;
    }

    uint lit = 0u, dark = 0u, mixed = 0u, kept = 0u;  // kept: cones, and from bit 16 on others
    for (uint begin = 0u; begin < all_; begin += kBlockSize) {
        const uint i = begin + lane;
        const bool there = i < all_, cone = i < cones;
        const uint entry = there ? imageLoad(entries, cone ? first + int(i) : last - int(i - cones)).r : 0u;
        uint visible = there ? found[i] : kDark, mark = 0u;
        const bool matters = there && is_open(visible) && brightest[i] > limit;
        // Lamps that all pixels look at, one after another.
        uint next = subgroupMax(matters ? i + 1u : 0u);
        while (next != 0u) {
            const bool mine = i + 1u == next;
            const uint lamp = subgroupMax(mine ? lamp_of(entry) : 0u);
            uint word;
            const uint sees_it = look(lamp, word);
            if (sees_it == kMixed)
                imageStore(shares, int((block * kSharePlaces + mixed) * kBlockSize + lane), uvec4(word));
            visible = mine ? sees_it : visible;
            mark = mine && sees_it == kMixed ? kMixedBit | mixed << kShareShift : mark;
            mixed += sees_it == kMixed ? 1u : 0u;
            next = subgroupMax(matters && i + 1u < next ? i + 1u : 0u);
        }
        mark = visible < kShares ? visible << kShareShift : mark;
        const bool stays = visible != kDark;
        const uint one = stays ? (cone ? 1u : 1u << 16u) : 0u, before = kept + subgroupExclusiveAdd(one);
        if (stays) imageStore(entries, cone ? first + int(before & 0xffffu) : last - int(before >> 16u), uvec4(entry | mark));
        kept += subgroupAdd(one);
        lit += visible == kLit ? 1u : 0u;
        dark += there && visible == kDark ? 1u : 0u;
    }
    lit = subgroupAdd(lit), dark = subgroupAdd(dark);
    if (lane != 0u) return;
    imageStore(block_counts, counts, uvec4(kept & 0xffffu));
    imageStore(block_counts, counts + 1, uvec4(kept >> 16u));
    imageAtomicAdd(report, 0, lit);
    imageAtomicAdd(report, 1, dark);
    imageAtomicAdd(report, 2, mixed);
    imageAtomicAdd(report, 3, all_ - lit - dark - mixed);
}
