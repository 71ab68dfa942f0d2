#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require

// The share of each lamp in the picture's light, as if nothing hid it: in the middle pixel of some blocks, one block per
// workgroup, the illuminance of each lamp on the block's list over that of all of them. Sums are whole numbers, so that they have no order.

#include "blocks.glsl"
#include "normal.glsl"
#include "texels.glsl"
#include "shared/visibility.h"

layout(local_size_x = 8) in;  // kBlockSize
layout(constant_id = 0) const uint kPowers = 1u;    // there are cosine powers,
layout(constant_id = 1) const uint kTables = 1u;    // measured distributions
layout(constant_id = 2) const uint kLockstep = 0u;  // see lanes.glsl

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
TEXELS(1, vec4, lamps);
TEXELS(2, uint, block_counts);
TEXELS(3, uint, entries);
TEXELS(4, vec4, tables);
layout(binding = 5, scalar) buffer Sums { uint sums[]; };  // of each lamp; then how many blocks look at every lamp
layout(push_constant, scalar) uniform Push { LightSharesPush push; };

#include "lamp.glsl"
#include "lanes.glsl"

shared float light[kBlockCapacity];  // lx

uint entry_at(uint i, uint cones, uint first) {
    return texel_at(entries, int(i < cones ? first + i : first + push.capacity - 1u - (i - cones))).r;
}

// Of a lamp on the list of a block, if the entry is for these slices, lx.
float illuminance(uint entry, bool cone, uint slices, vec3 position, vec3 normal) {
    const FetchedLamp lamp = fetch(lamp_of(entry), cone, push.lamps.cones + push.lamps.powers);
    const vec3 to = lamp.position - position;
    const float inverse = inversesqrt(max(dot(to, to), 1e-12));
    const float relative = relative_intensity(lamp, -dot(lamp.axis, to) * inverse, -to, inverse, cone);
    const float lux = lamp.intensity * relative * max(dot(normal, to) * inverse, 0.0) * inverse * inverse;
    return (slices_of(entry) & slices) == 0u ? 0.0 : lux;
}

void main() {
    const uint lane = gl_LocalInvocationID.x, lamps_in_all = push.lamps.cones + push.lamps.powers + push.lamps.tables;
    const uvec2 place = gl_WorkGroupID.xy * push.step;
    const uint block = place.y * push.blocks_x + place.x, first = block * push.capacity;
    const uint cones = texel_at(block_counts, int(2u * block)).r;
    const bool every = cones == kAllLamps;
    if (every && lane == 0u) atomicAdd(sums[lamps_in_all], 1u);
    const uvec2 pixel = min(place * kBlockSize + kBlockSize / 2u, push.size - 1u);
    const vec4 surface = imageLoad(surface_image, ivec2(pixel));
    const uint number = every || !(surface.z > 0.0) ? 0u : cones + texel_at(block_counts, int(2u * block + 1u)).r;
    if (number == 0u) return;
    const uint slices = slice_bit(push.grid, surface.z);
    const vec3 position = pixel_ray(push.grid, vec2(pixel)) * surface.z, normal = decode_normal(surface.xy);
    float sum = 0.0;
    uint begin = 0u;
    do {
        const uint i = begin + lane;
        if (i < number) {
            light[i] = illuminance(entry_at(i, cones, first), i < cones, slices, position, normal);
            sum += light[i];
        }
        begin += kBlockSize;
    } while (begin < number);
    sum = lanes_add(sum);
    if (!(sum > 0.0 && sum < 1e30)) return;
    begin = 0u;
    do {
        const uint i = begin + lane;
        const uint share = i < number ? uint(light[i] / sum * float(push.whole) + 0.5) : 0u;
        if (share > 0u) atomicAdd(sums[lamp_of(entry_at(i, cones, first))], share);
        begin += kBlockSize;
    } while (begin < number);
}
