#include "render/passes/blocks.h"

#include "shaders/blocks/cull_lamps.comp.inc"
#include "shaders/blocks/merge_lamps.comp.inc"
#include "shared/blocks.h"
#include "shared/visibility.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store, graph::update;

constexpr gpu::Shader kCullLamps{"cull_lamps.comp", cull_lamps_comp, cull_lamps_comp_storage},
    kMergeLamps{"merge_lamps.comp", merge_lamps_comp, merge_lamps_comp_storage};

constexpr uint64_t kWord = sizeof(uint32_t);
constexpr VkFormat kWords = VK_FORMAT_R32_UINT;

// The words of classes that have no blocks yet.
std::vector<uint32_t> empty_classes() {
    std::vector<uint32_t> words;
    for (uint32_t k = 0; k < shared::kBlockClasses; ++k) words.insert(words.end(), {0, 1, 1, 0});
    static_assert(shared::kClassWords == 4);
    return words;
}

graph::Resource words(graph::FrameGraph& graph, const char* name, uint64_t number) {
    return graph.transient(name, graph::buffer_shape(number * kWord, kWords));
}

}  // namespace

Blocks add_blocks(const FrameContext& frame, const GBuffer& surfaces, const Clusters& clusters) {
    graph::FrameGraph& graph = frame.graph;
    const VkExtent2D extent = frame.view.extent;
    const LampKinds kinds = lamp_kinds(clusters);
    const graph::Groups grid = graph::cover(extent.width, extent.height, shared::kBlockSize, shared::kBlockSize);
    const glm::uvec2 pixels{extent.width, extent.height};
    const uint32_t count = grid.x * grid.y;
    if ((count + shared::kBlocksPerGroup - 1) / shared::kBlocksPerGroup >
        frame.kernels.device().limits().maxComputeWorkGroupCount[0])
        throw Error(
            "an image of " + std::to_string(extent.width) + " x " + std::to_string(extent.height) +
            " has more blocks than the device can shade in one dispatch: a smaller one (--size, or size_px of a "
            "channel) has fewer");
    const Blocks blocks{
        .columns = grid.x,
        .count = count,
        .capacity = shared::kBlockCapacity,
        .counts = words(graph, "block counts", count * 2),
        .entries = words(graph, "block entries", uint64_t(count) * shared::kBlockCapacity),
        .visibility = graph.transient("visibility report", graph::buffer_shape(sizeof(shared::VisibilityReport)))};
    graph.clear("clear visibility report", blocks.visibility);

    const gpu::Kernel& cull = frame.kernels.get(kCullLamps, {kinds.powers, kinds.tables});
    graph.dispatch(
        "cull lamps", cull,
        {load(surfaces.surface), sample(clusters.lamps), sample(clusters.counts), sample(clusters.indices),
         store(blocks.counts), store(blocks.entries), sample(clusters.tables.texels), sample(clusters.block_slices)},
        shared::CullPush{clusters.push, pixels, grid.x, shared::kBlockCapacity},
        graph::cover(grid.x, grid.y, cull.group[0], cull.group[1]));

    return blocks;
}

Blocks add_merging(const FrameContext& frame, const GBuffer& surfaces, const Clusters& clusters, Blocks blocks,
                   float merge_error) {
    graph::FrameGraph& graph = frame.graph;
    const VkExtent2D extent = frame.view.extent;
    const LampKinds kinds = lamp_kinds(clusters);
    const uint32_t rows = blocks.count / blocks.columns, maps = blocks.shares ? 1 : 0;
    blocks.sums = graph.transient(
        "block sums", graph::buffer_shape(uint64_t(blocks.count) * shared::kMergedTexels * sizeof(glm::vec4),
                                          VK_FORMAT_R32G32B32A32_SFLOAT));
    blocks.class_counts = words(graph, "class counts", shared::kBlockClasses * shared::kClassWords);
    blocks.class_blocks = words(graph, "class blocks", uint64_t(blocks.count) * shared::kBlockClasses);
    graph.copy("begin classes", graph.upload("no blocks", empty_classes(), kWords), blocks.class_counts);
    const gpu::Kernel& merge =
        frame.kernels.get(kMergeLamps, {kinds.cones, kinds.powers, kinds.tables, kinds.roads, maps});
    graph.dispatch("merge lamps", merge,
                   {load(surfaces.reflectance), load(surfaces.surface), sample(clusters.lamps), update(blocks.counts),
                    update(blocks.entries), store(blocks.sums), sample(clusters.tables.texels),
                    update(blocks.class_counts), store(blocks.class_blocks)},
                   shared::MergePush{.view = clusters.push,
                                     .size = {extent.width, extent.height},
                                     .blocks_x = blocks.columns,
                                     .blocks_y = rows,
                                     .capacity = blocks.capacity,
                                     .roads = clusters.tables.roads,
                                     .merge_error = merge_error},
                   graph::cover(blocks.columns, rows, merge.group[0], 1));
    return blocks;
}

}  // namespace vesper::render
