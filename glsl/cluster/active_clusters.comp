#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// The slices of depth that something is drawn in, a bit for each: of every block of pixels, one block per invocation, and of every tile.

#include "blocks.glsl"

layout(local_size_x = 8, local_size_y = 8) in;  // the blocks of a tile

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
layout(binding = 1, scalar) writeonly buffer BlockSlices { uint block_slices[]; };
layout(binding = 2, scalar) buffer TileSlices { uint tile_slices[]; };
layout(push_constant, scalar) uniform Push { ActiveClustersPush push; };

void main() {
    const uvec2 corner = gl_GlobalInvocationID.xy * kBlockSize, end = min(corner + kBlockSize, push.size);
    if (any(greaterThanEqual(corner, push.size))) return;
    uint slices = 0u;
    for (uint y = corner.y; y < end.y; ++y)
        for (uint x = corner.x; x < end.x; ++x) slices |= slice_bit(push.grid, imageLoad(surface_image, ivec2(x, y)).z);
    block_slices[gl_GlobalInvocationID.y * push.blocks_x + gl_GlobalInvocationID.x] = slices;
    atomicOr(tile_slices[gl_WorkGroupID.y * push.grid.tiles_x + gl_WorkGroupID.x], slices);
}
