#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Light selection, one block of pixels per invocation: of the lights listed for the froxels that the block's pixels lie
// in, those that can light what is drawn there. A box around the positions is tighter than a froxel, and a box around the
// normals tells which lights are behind every surface. What is left out gives nothing to any pixel of the block.

#include "normal.glsl"
#include "reach.glsl"
#include "shared/shade.h"

layout(local_size_x = 64) in;

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
layout(binding = 1) uniform samplerBuffer lights;
layout(binding = 2) uniform usamplerBuffer counts;
layout(binding = 3) uniform usamplerBuffer indices;
layout(binding = 4, r32ui) writeonly uniform uimageBuffer block_counts;
layout(binding = 5, r32ui) writeonly uniform uimageBuffer entries;
layout(push_constant, scalar) uniform Push { SelectPush push; };

const uint kNoSlice = 32u;
const uint kMaxTurns = 7000u;  // of one invocation; a CPU device counts those of eight together

vec3 position_low, position_high, normal_low, normal_high;

// Finds the nearest slice at or beyond `from` that has pixels in the block, boxes around them, and the farthest slice of the
// block. Returns kNoSlice when there is none.
uint bound_slice(uvec2 corner, uint from, out uint farthest) {
    const ClusterGrid grid = push.view.grid;
    uint nearest = kNoSlice;
    farthest = 0u;
    const uvec2 end = min(corner + kBlockSize, push.size);
    for (uint y = corner.y; y < end.y; ++y) {
        for (uint x = corner.x; x < end.x; ++x) {
            const vec4 surface = imageLoad(surface_image, ivec2(x, y));
            const float at = clamp(log2(surface.z) * grid.slice_scale + grid.slice_bias, 0.0, float(grid.slices) - 1.0);
            const uint slice = surface.z > 0.0 ? uint(at) : kNoSlice;
            const bool nearer = slice >= from && slice < nearest;
            const bool here = slice >= from && slice <= nearest && slice != kNoSlice;
            const vec3 position = vec3(grid.ray_scale * (vec2(x, y) + 0.5) + grid.ray_offset, -1.0) * surface.z;
            const vec3 normal = decode_normal(surface.xy);
            nearest = nearer ? slice : nearest;
            farthest = slice != kNoSlice ? max(farthest, slice) : farthest;
            position_low = nearer ? position : here ? min(position_low, position) : position_low;
            position_high = nearer ? position : here ? max(position_high, position) : position_high;
            normal_low = nearer ? normal : here ? min(normal_low, normal) : normal_low;
            normal_high = nearer ? normal : here ? max(normal_high, normal) : normal_high;
        }
    }
    return nearest;
}

// The largest value of a * b over two intervals.
vec3 largest_product(vec3 a_low, vec3 a_high, vec3 b_low, vec3 b_high) {
    return max(max(a_low * b_low, a_low * b_high), max(a_high * b_low, a_high * b_high));
}

bool lights_block(uint light, bool power) {
    const int texel = int(light * kTexelsPerLight);
    const vec4 a = texelFetch(lights, texel), b = texelFetch(lights, texel + 1);
    const float lobe_b = texelFetch(lights, texel + 2).w;
    const vec3 centre = 0.5 * (position_low + position_high);
    const float radius = kSlack * 0.5 * distance(position_low, position_high);
    const float nearest = distance(a.xyz, clamp(a.xyz, position_low, position_high)) / kSlack;
    const float cosine = nearest_cosine(a.xyz, b.xyz, centre, radius);
    const float largest = a.w * (power ? largest_power(b.w, cosine) : largest_cone(b.w, lobe_b, cosine));
    // n . (lamp - surface) is at most the sum of the largest products of its parts; behind everything if that is negative.
    const vec3 facing = largest_product(normal_low, normal_high, a.xyz - position_high, a.xyz - position_low);
    const float slack = 1e-5 * (abs(facing.x) + abs(facing.y) + abs(facing.z));
    return facing.x + facing.y + facing.z > -slack && reaches(largest, nearest, push.view.threshold);
}

void main() {
    const uint block = gl_GlobalInvocationID.x;
    if (block >= push.blocks) return;
    const uvec2 corner = uvec2(block % push.blocks_x, block / push.blocks_x) * kBlockSize;
    const uvec2 tile = corner / kTileSize;
    const uint base = block * push.capacity;
    uint cones = 0u, powers = 0u, turns = 0u;
    bool fits = true;
    uint farthest, slice = bound_slice(corner, 0u, farthest);
    while (fits && slice != kNoSlice) {
        const uint cell = (slice * push.view.grid.tiles_y + tile.y) * push.view.grid.tiles_x + tile.x;
        const uint cell_cones = texelFetch(counts, int(2u * cell)).r;
        // Where a froxel overflowed, or the lists are very long together, the block looks at every light, too: lavapipe
        // silently ends the loops of an invocation after 65,535 turns in all.
        uint cell_lights = cell_cones == kAllLights ? 0u : cell_cones + texelFetch(counts, int(2u * cell + 1u)).r;
        turns += cell_lights;
        fits = cell_cones != kAllLights && turns <= kMaxTurns;
        cell_lights = fits ? cell_lights : 0u;
        const uint list = cell * push.view.grid.capacity;
        for (uint i = 0u; i < cell_lights; ++i) {
            const uint light = texelFetch(indices, int(list + i)).r;
            const bool power = i >= cell_cones;
            if (!lights_block(light, power)) continue;
            const uint at = power ? push.capacity - 1u - powers : cones;
            if (cones + powers < push.capacity) imageStore(entries, int(base + at), uvec4(light | slice << kSliceShift));
            powers += power ? 1u : 0u;
            cones += power ? 0u : 1u;
        }
        fits = fits && cones + powers <= push.capacity;
        slice = slice < farthest ? bound_slice(corner, slice + 1u, farthest) : kNoSlice;
    }
    imageStore(block_counts, int(2u * block), uvec4(fits ? cones : kAllLights));
    imageStore(block_counts, int(2u * block + 1u), uvec4(fits ? powers : kAllLights));
}
