#include "render/passes/cluster.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/scene.h"
#include "shaders/cluster/active_clusters.comp.inc"
#include "shaders/cluster/cluster.comp.inc"
#include "shared/shade.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store, graph::update;

constexpr gpu::Shader kActiveClusters{"active_clusters.comp", active_clusters_comp},
    kCluster{"cluster.comp", cluster_comp, cluster_comp_storage};

constexpr float kNear = 1;  // m, where slice 1 begins
constexpr uint32_t kMaxSlices = 32, kMaxCapacity = 4096;
constexpr uint32_t kCoarseTiles = 4;  // side of a coarse cell
constexpr uint32_t kCoarseSlices = 4;
constexpr uint64_t kCoarseIndices = 8u << 20;  // bound on the memory of the coarse lists

uint32_t divide_up(uint32_t a, uint32_t b) { return (a + b - 1) / b; }

// The greatest depth at which any lamp still gives the threshold.
float lit_depth(const gpu_scene::LampList& list, float threshold) {
    float far = 2 * kNear;
    for (uint32_t i = 0; i < list.placed(); ++i)
        far = std::max(far, std::sqrt(list.lamps[i].intensity / threshold) - list.lamps[i].position.z);
    return far;
}

void check_limits(uint32_t lamps, const ClusterSettings& settings) {
    const auto in_range = [](const char* what, uint32_t value, uint32_t low, uint32_t high) {
        if (value < low || value > high)
            throw Error("clusters: " + std::to_string(value) + " " + what + "; " + std::to_string(low) + " to " +
                        std::to_string(high) + " are possible");
    };
    in_range("lamps", lamps, 0, scene::kMaxLamps);
    in_range("slices", settings.slices, 2, kMaxSlices);
    in_range("lamps in a list", settings.capacity, 1, kMaxCapacity);
}

struct LampLists {
    graph::Resource counts, indices;
};

}  // namespace

LampKinds lamp_kinds(const Clusters& clusters) {
    const shared::LampCounts& lamps = clusters.push.lamps;
    return {lamps.cones != 0, lamps.powers != 0, lamps.tables != 0, clusters.tables.has_roads};
}

Clusters add_clusters(const FrameContext& frame, graph::Resource surface, const gpu_scene::LampList& list,
                      const TableTexels& tables, const ClusterSettings& settings) {
    graph::FrameGraph& graph = frame.graph;
    const gpu_scene::View& view = frame.view;
    const uint32_t lamps = list.placed();
    check_limits(lamps, settings);
    float far = lit_depth(list, settings.threshold);
    if (settings.far > 0) far = std::max(2 * kNear, std::min(far, settings.far));
    const float slice_scale = float(settings.slices - 1) / std::log2(far / kNear);

    Clusters clusters;
    clusters.tables = tables;
    clusters.push.grid = {divide_up(view.extent.width, shared::kTileSize),
                          divide_up(view.extent.height, shared::kTileSize),
                          settings.slices,
                          settings.capacity,
                          slice_scale,
                          1 - std::log2(kNear) * slice_scale,
                          view.ray_scale(),
                          view.ray_offset()};
    clusters.push.lamps = list.counts;
    clusters.push.threshold = settings.threshold;
    clusters.push.far = far;

    std::vector<shared::Lamp> padded = list.lamps;
    if (padded.empty()) padded.emplace_back();  // an upload is never empty
    clusters.lamps = graph.upload("lamps", padded, VK_FORMAT_R32G32B32A32_SFLOAT);

    const shared::ClusterGrid& grid = clusters.push.grid;
    const graph::Groups blocks =
        graph::cover(view.extent.width, view.extent.height, shared::kBlockSize, shared::kBlockSize);
    const auto words = [&](const std::string& name, uint64_t number) {
        return graph.transient(name, graph::buffer_shape(number * sizeof(uint32_t), VK_FORMAT_R32_UINT));
    };
    clusters.block_slices = words("block slices", blocks.x * blocks.y);
    const graph::Resource tile_slices = words("tile slices", grid.tiles_x * grid.tiles_y);
    graph.clear("clear tile slices", tile_slices);
    const gpu::Kernel& active = frame.kernels.get(kActiveClusters);
    graph.dispatch("active clusters", active, {load(surface), store(clusters.block_slices), update(tile_slices)},
                   shared::ActiveClustersPush{grid, {view.extent.width, view.extent.height}, blocks.x},
                   graph::cover(blocks.x, blocks.y, active.group[0], active.group[1]));

    // The root is one cell that lists every lamp; coarse cells choose from it, froxels from coarse cells.
    std::vector<uint32_t> every_lamp(std::max(1u, lamps));
    std::iota(every_lamp.begin(), every_lamp.end(), 0u);
    const LampLists root{
        graph.upload("root counts", std::vector{list.counts.cones, list.counts.powers + list.counts.tables},
                     VK_FORMAT_R32_UINT),
        graph.upload("root indices", every_lamp, VK_FORMAT_R32_UINT)};

    clusters.report = graph.transient("cluster report", graph::buffer_shape(sizeof(shared::ClusterReport)));
    graph.clear("clear cluster report", clusters.report);

    const LampKinds kinds = lamp_kinds(clusters);
    const gpu::Kernel& kernel = frame.kernels.get(kCluster, {kinds.powers, kinds.tables, frame.lockstep()});
    const auto add_level = [&](const char* name, const LampLists& parents, shared::ClusterLevelPush push) {
        push.view = clusters.push;
        const uint32_t cells = push.cells_x * push.cells_y * push.cells_z;
        const LampLists lists{words(std::string(name) + " counts", uint64_t(cells) * 2),
                              words(std::string(name) + " indices", uint64_t(cells) * push.capacity)};
        graph.dispatch(name, kernel,
                       {sample(clusters.lamps), sample(parents.counts), sample(parents.indices), store(lists.counts),
                        store(lists.indices), update(clusters.report), sample(tables.texels), sample(tile_slices)},
                       push, graph::Groups{push.cells_x, push.cells_y, push.cells_z});
        return lists;
    };

    const uint32_t coarse_x = divide_up(grid.tiles_x, kCoarseTiles), coarse_y = divide_up(grid.tiles_y, kCoarseTiles);
    const uint32_t coarse_z = divide_up(grid.slices, kCoarseSlices);
    // In steps, so that lists keep their size from frame to frame.
    const uint64_t most = kCoarseIndices / (coarse_x * coarse_y * coarse_z), room = (lamps + 255ull) / 256 * 256;
    const auto coarse_capacity = uint32_t(std::clamp<uint64_t>(room, 1, most));
    const LampLists coarse = add_level("cluster coarse", root,
                                       {.cells_x = coarse_x,
                                        .cells_y = coarse_y,
                                        .cells_z = coarse_z,
                                        .tiles_per_cell = kCoarseTiles,
                                        .slices_per_cell = kCoarseSlices,
                                        .capacity = coarse_capacity,
                                        .parents_x = 1,
                                        .parents_y = 1,
                                        .tiles_per_parent = coarse_x * kCoarseTiles * coarse_y,
                                        .slices_per_parent = coarse_z * kCoarseSlices,
                                        .parent_capacity = 0,
                                        .reports = 0});
    const LampLists fine = add_level("cluster", coarse,
                                     {.cells_x = grid.tiles_x,
                                      .cells_y = grid.tiles_y,
                                      .cells_z = grid.slices,
                                      .tiles_per_cell = 1,
                                      .slices_per_cell = 1,
                                      .capacity = grid.capacity,
                                      .parents_x = coarse_x,
                                      .parents_y = coarse_y,
                                      .tiles_per_parent = kCoarseTiles,
                                      .slices_per_parent = kCoarseSlices,
                                      .parent_capacity = coarse_capacity,
                                      .reports = 1});
    clusters.counts = fine.counts;
    clusters.indices = fine.indices;
    return clusters;
}

}  // namespace vesper::render
