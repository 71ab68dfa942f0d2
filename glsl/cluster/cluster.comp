#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require

// Clusters and their lists of lamps, one cell per workgroup, which tries some lamps at a time. Where nothing is drawn no lamp is listed. Elsewhere, a lamp is listed
// unless its illuminance stays under the threshold all over the sphere around the cell: the largest intensity in the cone
// of directions that the sphere subtends, over the square of the nearest distance. Lamps are tried in ascending order, so lists are ascending and the same on every run.

#include "texels.glsl"
#include "shared/cluster.h"

layout(local_size_x = 8) in;  // the corners of a cell
layout(constant_id = 0) const uint kPowers = 1u;  // there are cosine powers,
layout(constant_id = 1) const uint kTables = 1u;    // measured distributions
layout(constant_id = 2) const uint kLockstep = 0u;  // see lanes.glsl

TEXELS(0, vec4, lamps);
TEXELS(1, uint, parent_counts);
TEXELS(2, uint, parent_indices);
layout(binding = 3, scalar) writeonly buffer Counts { uint counts[]; };
layout(binding = 4, scalar) writeonly buffer Indices { uint indices[]; };
layout(binding = 5, scalar) buffer Report { ClusterReport report; };
TEXELS(6, vec4, tables);
TEXELS(7, uint, tile_slices);
layout(push_constant, scalar) uniform Push { ClusterLevelPush push; };

#include "lanes.glsl"
#include "light_bounds.glsl"

vec3 centre;
float radius;

// Where the cell lies in the view frame: the sphere through its farthest corner.
void bound_cell(uvec3 cell) {
    const ClusterGrid grid = push.view.grid;
    const float side = float(kTileSize * push.tiles_per_cell);
    const vec2 low = grid.ray_scale * (side * vec2(cell.xy)) + grid.ray_offset;
    const vec2 high = grid.ray_scale * (side * vec2(cell.xy + 1u)) + grid.ray_offset;
    const float first = float(cell.z * push.slices_per_cell), last = float((cell.z + 1u) * push.slices_per_cell);
    const float z0 = cell.z == 0u ? 0.0 : exp2((first - grid.slice_bias) / grid.slice_scale);
    const float z1 = last >= float(grid.slices) ? push.view.far : exp2((last - grid.slice_bias) / grid.slice_scale);
    centre = vec3(0.5 * (low + high), -1.0) * (0.5 * (z0 + z1));
    const uint corner = gl_LocalInvocationID.x;  // one of eight for each
    const vec2 ray = vec2((corner & 1u) == 0u ? low.x : high.x, (corner & 2u) == 0u ? low.y : high.y);
    radius = kSlack * lanes_max(distance(centre, vec3(ray, -1.0) * ((corner & 4u) == 0u ? z0 : z1)));
}

// Whether anything is drawn in some of its froxels.
bool is_active(uvec3 cell) {
    const ClusterGrid grid = push.view.grid;
    const uvec2 first = cell.xy * push.tiles_per_cell, end = min(first + push.tiles_per_cell, uvec2(grid.tiles_x, grid.tiles_y));
    uint slices = 0u;
    for (uint y = first.y; y < end.y; ++y)
        for (uint x = first.x; x < end.x; ++x) slices |= texel_at(tile_slices, int(y * grid.tiles_x + x)).r;
    return (slices >> cell.z * push.slices_per_cell & (1u << push.slices_per_cell) - 1u) != 0u;
}

bool counts_here(uint lamp, bool cone) {
    const int at = int(lamp * kTexelsPerLamp);
    const vec4 a = texel_at(lamps, at);
    const bool measured = !cone && kTables != 0u && (kPowers == 0u || lamp >= push.view.lamps.cones + push.view.lamps.powers);
    return gives_threshold(largest_intensity(at, a, cone, measured, centre, radius), distance(centre, a.xyz) - radius, push.view.threshold);
}

// Lists some of the parent's lamps, those that count here. `from`: before the first of them; `count`: so many are listed.
uint list_lamps(uint from, uint number, bool cone, bool all_of_them, uint base, uint count) {
    for (uint begin = 0u; begin < number; begin += gl_WorkGroupSize.x) {
        const uint i = begin + gl_LocalInvocationID.x;
        const uint lamp = all_of_them || i >= number ? from + i : texel_at(parent_indices, int(from + i)).r;
        const bool listed = i < number && counts_here(lamp, cone);
        const uint at = count + lanes_add_before(listed ? 1u : 0u);
        if (listed && at < push.capacity) indices[base + at] = lamp;
        count += lanes_add(listed ? 1u : 0u);
    }
    return count;
}

void main() {
    const uvec3 cell = gl_WorkGroupID;
    const uint index = (cell.z * push.cells_y + cell.y) * push.cells_x + cell.x;
    bound_cell(cell);

    const uvec3 parent = uvec3(cell.xy * push.tiles_per_cell / push.tiles_per_parent,
                               cell.z * push.slices_per_cell / push.slices_per_parent);
    const uint parent_index = (parent.z * push.parents_y + parent.y) * push.parents_x + parent.x;
    const uint listed_cones = texel_at(parent_counts, int(2u * parent_index)).r;
    const uint listed_others = texel_at(parent_counts, int(2u * parent_index + 1u)).r;
    const bool all_of_them = listed_cones == kAllLamps;
    const bool drawn = is_active(cell);
    const uint cones = !drawn ? 0u : all_of_them ? push.view.lamps.cones : listed_cones;
    const uint others = !drawn ? 0u : all_of_them ? push.view.lamps.powers + push.view.lamps.tables : listed_others;
    const uint list = all_of_them ? 0u : parent_index * push.parent_capacity, base = index * push.capacity;
    const uint kept_cones = list_lamps(list, cones, true, all_of_them, base, 0u);
    const uint count = list_lamps(list + cones, others, false, all_of_them, base, kept_cones);
    if (gl_LocalInvocationID.x != 0u) return;

    const bool fits = count <= push.capacity;
    counts[2u * index] = fits ? kept_cones : kAllLamps;
    counts[2u * index + 1u] = fits ? count - kept_cones : kAllLamps;
    if (push.reports != 0u) {
        atomicAdd(report.overflowed, fits ? 0u : 1u);
        atomicMax(report.longest, count);
        atomicAdd(report.listed, count);
    }
}
