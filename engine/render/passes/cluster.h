// Lists of the lamps of each froxel. SPDX-License-Identifier: MIT
#pragma once

#include "gpu_scene/lamps.h"
#include "render/frame_context.h"
#include "render/light_settings.h"
#include "shared/cluster.h"

namespace vesper::render {

struct ClusterSettings {
    float threshold =
        LightSettings{}
            .threshold;  ///< lx: a lamp counts where it gives at least this, on matt surfaces or on a plane facing it
    uint32_t slices = 32;
    uint32_t capacity = 512;  ///< lamps a froxel lists before it falls back to all lamps
    float far = 0;            ///< m, where geometry ends; 0: unknown, lamps alone decide
};

/// The texels of IntensityTables (rgba32f), and the index of the first cell of the first road table.
struct TableTexels {
    graph::Resource texels;
    uint32_t roads = 0;
    bool has_roads = false;
};

struct Clusters {
    TableTexels tables;
    graph::Resource lamps;  ///< rgba32f texels, kTexelsPerLamp per lamp
    graph::Resource
        counts;  ///< r32ui, two per froxel: cones, then cosine powers and tables; kAllLamps if they did not fit
    graph::Resource indices;  ///< r32ui, grid.capacity per froxel: indices of cones, then of the others, each ascending
    graph::Resource report;   ///< shared::ClusterReport
    graph::Resource block_slices;  ///< r32ui, for each block of shared::kBlockSize pixels the slices that have a
                                   ///< surface, a bit each
    shared::ClusterPush push;      ///< grid, counts, threshold and far
};

/// Lists, for every froxel that has a surface (`surface`: GBuffer::surface), all lamps that may give `threshold` lx
/// somewhere in it: exactly these or more, never fewer. Slices are of equal ratio from the nearest metre to the
/// farthest depth where any lamp gives `threshold` (d = sqrt(I / threshold)), or to `far` if that is nearer.
Clusters add_clusters(const FrameContext& frame, graph::Resource surface, const gpu_scene::LampList& lamps,
                      const TableTexels& tables, const ClusterSettings& settings);

/// The kinds of lamps and surfaces in a frame. Kernels have code for these alone.
struct LampKinds {
    bool cones, powers, tables;
    bool roads;  ///< with a reflection table
};
LampKinds lamp_kinds(const Clusters& clusters);

}  // namespace vesper::render
