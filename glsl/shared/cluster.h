// The froxel grid: square tiles of the image, cut by depth into slices of equal ratio. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_CLUSTER_H
#define VESPER_SHARED_CLUSTER_H
#include "lamp.h"
SHARED_BEGIN

const uint kTileSize = 64u;       // px, side of a tile
const uint kAllLamps = ~0u;      // list length of a froxel that overflowed: every lamp is looked at

// Maps pixels to view-frame rays and depths to slices. Depth z is the distance along the view axis, m.
struct ClusterGrid {
    uint tiles_x;
    uint tiles_y;
    uint slices;
    uint capacity;        // indices of lamps a froxel's list can hold
    float slice_scale;    // slice = clamp(floor(log2(z) * slice_scale + slice_bias), 0, slices - 1)
    float slice_bias;
    vec2 ray_scale;       // a pixel (x, y), y down, sees along (ray_scale * (pixel + 0.5) + ray_offset, -1)
    vec2 ray_offset;
};
SHARED_SIZE(ClusterGrid, 40)

struct ClusterPush {
    ClusterGrid grid;
    LampCounts lamps;
    float threshold;      // illuminance below which a lamp counts as dark, lx, on a surface facing it
    float far;            // depth where the last slice ends, m
};
SHARED_SIZE(ClusterPush, 64)

// Cells are froxels, or blocks of them: lists are made from coarse to fine, each level from the lists of the one before.
struct ClusterLevelPush {
    ClusterPush view;
    uint cells_x, cells_y, cells_z;        // of this level
    uint tiles_per_cell, slices_per_cell;  // side of a cell
    uint capacity;                         // indices of lamps a cell's list can hold
    uint parents_x, parents_y;             // of the level before
    uint tiles_per_parent, slices_per_parent;
    uint parent_capacity;
    uint reports;                          // 1: this level's overflow is reported
};
SHARED_SIZE(ClusterLevelPush, 112)

// What clustering has to report; zeroed every frame.
struct ClusterReport {
    uint overflowed;      // froxels whose lamps did not fit
    uint longest;         // lamps of the fullest froxel
    uint listed;          // sum of all list lengths
};
SHARED_SIZE(ClusterReport, 12)

SHARED_END
#endif
