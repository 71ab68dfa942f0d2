#include <array>

#include "render/passes/passes.h"
#include "shared/gather.h"

namespace vesper {
namespace {

// What is in the blocks of a class, as bits of a shading kernel, beside the lamps that the frame has.
struct BlockClass {
    const char* name;
    uint32_t variant;
};
constexpr std::array<BlockClass, shared::kBlockClasses> kClasses{{
    {"shade empty", 0},
    {"shade matt", Kernels::kGathered},
    {"shade matt listed", Kernels::kGathered | Kernels::kListed},
    {"shade paved", Kernels::kGathered | Kernels::kRoads},
    {"shade paved listed", Kernels::kGathered | Kernels::kRoads | Kernels::kListed},
    {"shade glossy", Kernels::kGlossy | Kernels::kListed},
    {"shade glossy paved", Kernels::kGlossy | Kernels::kRoads | Kernels::kListed},
    {"shade retro", Kernels::kRetro | Kernels::kGlossy | Kernels::kListed},
}};

}  // namespace

Resource add_shading(FrameGraph& graph, const Kernels& kernels, const GBuffer& g, const Clusters& clusters, const View& view, const ShadeSettings& settings) {
    const Blocks blocks = add_blocks(graph, kernels, g, clusters, view, settings.all_lamps ? -1 : settings.gather_tolerance);
    shared::ShadePush push{.size = {view.extent.width, view.extent.height},
                           .grid = clusters.push.grid,
                           .lamps = clusters.push.lamps,
                           .threshold = clusters.push.threshold,
                           .lambert = settings.lambert,
                           .emission_limit = settings.emission_limit,
                           .ambient = settings.ambient,
                           .sky = settings.sky,
                           .blocks_x = blocks.columns,
                           .capacity = blocks.capacity,
                           .roads = clusters.tables.roads,
                           .blocks = blocks.count,
                           .block_class = 0};
    const Resource retro = settings.retro ? settings.retro : clusters.tables.texels;  // the binding must hold something
    const uint32_t frame = frame_variant(clusters) | (settings.retro ? Kernels::kRetro : 0u);
    for (push.block_class = 0; push.block_class < kClasses.size(); ++push.block_class) {
        const BlockClass& c = kClasses[push.block_class];
        if (c.variant & Kernels::kRoads & ~frame) continue;
        // The last class has any surfaces; without classes of retroreflection a sheet is a glossy surface.
        uint32_t variant = c.variant & Kernels::kRetro ? (c.variant & ~Kernels::kRetro) | (frame & (Kernels::kRetro | Kernels::kRoads)) : c.variant;
        if (variant & Kernels::kListed) variant |= (frame & (Kernels::kCones | Kernels::kPowers | Kernels::kMaps)) | (settings.all_lamps ? Kernels::kEveryLamp : 0u);
        graph.dispatch(c.name, kernels.shade(variant),
                       {load(g.reflectance), load(g.surface), update(g.emission), sample(clusters.lamps), sample(blocks.counts), sample(blocks.entries),
                        sample(clusters.tables.texels), sample(retro), sample(blocks.sums), sample(blocks.class_counts), sample(blocks.class_blocks)},
                       push, Arguments{blocks.class_counts, uint64_t(push.block_class) * shared::kClassWords * sizeof(uint32_t)});
    }
    return g.emission;
}

}  // namespace vesper
