// Pixels of a view, the slices they are in, and the entries of blocks (shared/shade.h).

#include "shared/shade.h"

// From the eye through the middle of a pixel; z is -1.
vec3 pixel_ray(ClusterGrid grid, vec2 pixel) { return vec3(grid.ray_scale * (pixel + 0.5) + grid.ray_offset, -1.0); }

uint froxel_of(ClusterGrid grid, uvec2 tile, uint slice) { return (slice * grid.tiles_y + tile.y) * grid.tiles_x + tile.x; }

// The slice of a depth as a bit; 0 where nothing is drawn.
uint slice_bit(ClusterGrid grid, float depth) {
    const float at = clamp(log2(depth) * grid.slice_scale + grid.slice_bias, 0.0, float(grid.slices) - 1.0);
    return depth > 0.0 ? 1u << uint(at) : 0u;
}

uint entry_of(uint lamp, uint first_slice, uint last_slice) { return lamp | first_slice << kFirstSliceShift | last_slice << kLastSliceShift; }
uint lamp_of(uint entry) { return entry & ((1u << kShareShift) - 1u); }
// Of an entry with kMixedBit.
uint place_of(uint entry) { return entry >> kShareShift & kShareMask; }
// That all pixels see.
float share_of(uint entry) {
    const uint share = place_of(entry);
    return share == 0u || (entry & kMixedBit) != 0u ? 1.0 : float(share) / float(kShares);
}
// A bit for each.
uint slices_of(uint entry) { return (2u << (entry >> kLastSliceShift)) - (1u << (entry >> kFirstSliceShift & 31u)); }
