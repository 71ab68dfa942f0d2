#include "render/passes/passes.h"
#include "shared/gather.h"

namespace vesper {
namespace {

constexpr uint32_t kBlockCapacity = 256;  // lamps of a block of pixels; more, and it looks at every light

constexpr uint64_t kWord = sizeof(uint32_t);
constexpr VkFormat kWords = VK_FORMAT_R32_UINT;

// The words of classes that have no blocks yet.
std::vector<uint32_t> empty_classes() {
    std::vector<uint32_t> words;
    for (uint32_t k = 0; k < shared::kBlockClasses; ++k) words.insert(words.end(), {0, 1, 1, 0});
    static_assert(shared::kClassWords == 4);
    return words;
}

}  // namespace

uint32_t frame_variant(const Clusters& clusters) {
    const shared::LampCounts& lamps = clusters.push.lamps;
    uint32_t variant = 0;
    if (lamps.cones) variant |= Kernels::kCones;
    if (lamps.powers) variant |= Kernels::kPowers;
    if (lamps.tables) variant |= Kernels::kMaps;
    if (clusters.tables.has_roads) variant |= Kernels::kRoads;
    return variant;
}

Blocks add_blocks(FrameGraph& graph, const Kernels& kernels, const GBuffer& g, const Clusters& clusters, const View& view, float tolerance) {
    const Groups grid = cover(view.extent.width, view.extent.height, shared::kBlockSize, shared::kBlockSize);
    const glm::uvec2 pixels{view.extent.width, view.extent.height};
    const uint32_t count = grid.x * grid.y, variant = frame_variant(clusters);
    if ((count + shared::kBlocksPerGroup - 1) / shared::kBlocksPerGroup > kernels.most_groups())
        throw Error("an image of " + std::to_string(view.extent.width) + " x " + std::to_string(view.extent.height) + " has more blocks than the device can shade in one dispatch");
    const auto words = [&](const char* name, uint64_t number) { return graph.transient(name, buffer_shape(number * kWord, kWords)); };
    const Blocks blocks{.columns = grid.x,
                        .count = count,
                        .capacity = kBlockCapacity,
                        .counts = words("block counts", count * 2),
                        .entries = words("block entries", uint64_t(count) * kBlockCapacity),
                        .sums = graph.transient("block sums", buffer_shape(uint64_t(count) * shared::kGatherTexels * sizeof(glm::vec4), VK_FORMAT_R32G32B32A32_SFLOAT)),
                        .class_counts = words("class counts", shared::kBlockClasses * shared::kClassWords),
                        .class_blocks = words("class blocks", uint64_t(count) * shared::kBlockClasses)};

    const Kernel& select = kernels.select(variant);
    graph.dispatch("select", select,
                   {load(g.surface), sample(clusters.lamps), sample(clusters.counts), sample(clusters.indices), store(blocks.counts), store(blocks.entries), sample(clusters.tables.texels),
                    sample(clusters.block_slices)},
                   shared::SelectPush{clusters.push, pixels, grid.x, kBlockCapacity}, cover(grid.x, grid.y, select.group[0], select.group[1]));

    graph.copy("begin classes", graph.upload("no blocks", empty_classes(), kWords), blocks.class_counts);
    const Kernel& gather = kernels.gather(variant);
    graph.dispatch("gather", gather,
                   {load(g.reflectance), load(g.surface), sample(clusters.lamps), update(blocks.counts), update(blocks.entries), store(blocks.sums),
                    sample(clusters.tables.texels), update(blocks.class_counts), store(blocks.class_blocks)},
                   shared::GatherPush{.view = clusters.push, .size = pixels, .blocks_x = grid.x, .blocks_y = grid.y, .capacity = kBlockCapacity,
                                      .roads = clusters.tables.roads, .tolerance = tolerance},
                   cover(grid.x, grid.y, gather.group[0], 1));
    return blocks;
}

}  // namespace vesper
