#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Tile light culling, one block of pixels per invocation: of the lamps listed for the froxels that the block's pixels lie
// in, those that can light what is drawn there. A box around the positions is tighter than a froxel, and a box around the
// normals tells which lamps are behind every surface. What is left out gives nothing to any pixel of the block. A few
// slices of depth at a time share their boxes, so that a lamp listed in several of them is taken once.

#include "blocks.glsl"
#include "normal.glsl"
#include "texels.glsl"

layout(local_size_x = 8, local_size_y = 8) in;  // the blocks of a tile, whose lists they share

layout(constant_id = 0) const uint kPowers = 1u;  // there are cosine powers,
layout(constant_id = 1) const uint kTables = 1u;    // measured distributions

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
TEXELS(1, vec4, lamps);
TEXELS(2, uint, counts);
TEXELS(3, uint, indices);
layout(binding = 4, scalar) writeonly buffer BlockCounts { uint block_counts[]; };
writeonly WRITTEN_TEXELS(5, uint, entries);
TEXELS(6, vec4, tables);
TEXELS(7, uint, block_slices);
layout(push_constant, scalar) uniform Push { CullPush push; };

#include "light_bounds.glsl"

const uint kMaxTurns = 7000u;  // of one invocation; a CPU device counts those of eight together
const uint kTogether = 3u;     // slices that share a box

vec3 position_low, position_high, normal_low, normal_high;
bool matt;  // all of what is drawn in the slices

// Boxes around what is drawn in some of the block's slices.
void bound_slices(uvec2 corner, uint slices) {
    const ClusterGrid grid = push.view.grid;
    const uvec2 end = min(corner + kBlockSize, push.size);
    position_low = vec3(1e30), position_high = vec3(-1e30), normal_low = vec3(2.0), normal_high = vec3(-2.0);
    matt = true;
    for (uint y = corner.y; y < end.y; ++y) {
        for (uint x = corner.x; x < end.x; ++x) {
            const vec4 surface = imageLoad(surface_image, ivec2(x, y));
            const bool here = (slice_bit(grid, surface.z) & slices) != 0u;
            const vec3 position = pixel_ray(grid, vec2(x, y)) * surface.z;
            const vec3 normal = decode_normal(surface.xy);
            matt = matt && (!here || surface.w >= 1.0);
            position_low = here ? min(position_low, position) : position_low;
            position_high = here ? max(position_high, position) : position_high;
            normal_low = here ? min(normal_low, normal) : normal_low;
            normal_high = here ? max(normal_high, normal) : normal_high;
        }
    }
}

// The largest value of a * b over two intervals.
vec3 largest_product(vec3 a_low, vec3 a_high, vec3 b_low, vec3 b_high) {
    return max(max(a_low * b_low, a_low * b_high), max(a_high * b_low, a_high * b_high));
}

bool lights_block(uint lamp) {
    const bool measured = kTables != 0u && lamp >= push.view.lamps.cones + push.view.lamps.powers;
    const int at = int(lamp * kTexelsPerLamp);
    const vec4 a = texel_at(lamps, at);
    const vec3 centre = 0.5 * (position_low + position_high);
    const float radius = kSlack * 0.5 * distance(position_low, position_high);
    const float nearest = distance(a.xyz, clamp(a.xyz, position_low, position_high)) / kSlack;
    const float largest = largest_intensity(at, a, lamp < push.view.lamps.cones, measured, centre, radius);
    // n . (lamp - surface) is at most the sum of the largest products of its parts; behind everything if that is negative.
    const vec3 facing = largest_product(normal_low, normal_high, a.xyz - position_high, a.xyz - position_low);
    const float slack = 1e-5 * (abs(facing.x) + abs(facing.y) + abs(facing.z));
    // What a matt surface gets is less by a cosine, at most that product over the distance.
    const float product = facing.x + facing.y + facing.z + slack;
    const float cosine_here = matt ? min(kSlack * product / max(nearest, 1e-6), 1.0) : 1.0;
    return product > 0.0 && gives_threshold(largest * cosine_here, nearest, push.view.threshold);
}

// The ascending lists of several froxels, read as one without repetitions.
uint next_lamp[kTogether], list_at[kTogether], list_end[kTogether];

uint read_list(uint k) { return list_at[k] < list_end[k] ? texel_at(indices, int(list_at[k])).r : ~0u; }

// Opens the lists of the first of some slices of a tile, and takes these slices out. Returns their bits; 0 when a list has
// overflowed.
uint open_lists(uvec2 tile, inout uint slices) {
    const ClusterGrid grid = push.view.grid;
    uint opened = 0u;
    bool fits = true;
    [[unroll]] for (uint k = 0u; k < kTogether; ++k) {
        const bool any = slices != 0u;
        const uint slice = any ? uint(findLSB(slices)) : 0u;
        const uint cell = froxel_of(grid, tile, slice);
        const uint cones = texel_at(counts, int(2u * cell)).r;
        const uint others = texel_at(counts, int(2u * cell + 1u)).r;
        const bool overflowed = cones == kAllLamps;
        list_at[k] = cell * grid.capacity;
        list_end[k] = list_at[k] + (any && !overflowed ? cones + others : 0u);
        next_lamp[k] = read_list(k);
        fits = fits && !(any && overflowed);
        opened |= any ? 1u << slice : 0u;
        slices &= ~(any ? 1u << slice : 0u);
    }
    return fits ? opened : 0u;
}

uint take_lamp() {
    uint lamp = next_lamp[0];
    [[unroll]] for (uint k = 1u; k < kTogether; ++k) lamp = min(lamp, next_lamp[k]);
    [[unroll]] for (uint k = 0u; k < kTogether; ++k) {
        list_at[k] += next_lamp[k] == lamp ? 1u : 0u;
        next_lamp[k] = next_lamp[k] == lamp ? read_list(k) : next_lamp[k];
    }
    return lamp;
}

void main() {
    const uvec2 corner = gl_GlobalInvocationID.xy * kBlockSize;
    if (any(greaterThanEqual(corner, push.size))) return;
    const uint block = gl_GlobalInvocationID.y * push.blocks_x + gl_GlobalInvocationID.x;
    const uint base = block * push.capacity;
    uint cones = 0u, others = 0u, turns = 0u;
    bool fits = true;
    uint left = texel_at(block_slices, int(block)).r;
    while (fits && left != 0u) {
        const uint slices = open_lists(corner / kTileSize, left);
        fits = slices != 0u;
        bound_slices(corner, slices);
        const uint first = uint(findLSB(slices)), last = uint(findMSB(slices));
        // Where a froxel overflowed, or the lists are very long together, the block looks at every lamp, too: lavapipe
        // silently ends the loops of an invocation after 65,535 turns in all.
        for (uint lamp = fits ? take_lamp() : ~0u; lamp != ~0u && turns < kMaxTurns; lamp = take_lamp()) {
            ++turns;
            const bool cone = lamp < push.view.lamps.cones;
            if (!lights_block(lamp)) continue;
            const uint at = cone ? cones : push.capacity - 1u - others;
            if (cones + others < push.capacity) write_texel(entries, int(base + at), entry_of(lamp, first, last));
            others += cone ? 0u : 1u;
            cones += cone ? 1u : 0u;
        }
        fits = fits && cones + others <= push.capacity && turns < kMaxTurns;
    }
    block_counts[2u * block] = fits ? cones : kAllLamps;
    block_counts[2u * block + 1u] = fits ? others : kAllLamps;
}
