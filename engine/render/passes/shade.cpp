#include "render/passes/shade.h"

#include <array>

#include "render/pixel_groups.h"
#include "shaders/shade/shade.comp.inc"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::update;

constexpr gpu::Shader kShade{"shade.comp", shade_comp, shade_comp_storage};

// What a kernel has code for, as bits.
enum ShadeVariant : uint32_t {
    kEveryLamp = 1,
    kCones = 2,
    kPowers = 4,
    kTables = 8,
    kListed = 16,
    kMerged = 32,
    kGlossy = 64,
    kRoads = 128,
    kRetro = 256,
    kMaps = 512,
    kLookups = 1024,
    kClipmaps = 2048
};

// The kinds of lamps and surfaces in the frame.
uint32_t frame_variant(const Clusters& clusters, bool retro) {
    const LampKinds kinds = lamp_kinds(clusters);
    return (kinds.cones ? kCones : 0u) | (kinds.powers ? kPowers : 0u) | (kinds.tables ? kTables : 0u) |
           (kinds.roads ? kRoads : 0u) | (retro ? kRetro : 0u);
}

const gpu::Kernel& shade_kernel(const gpu::KernelCache& kernels, const PixelGroups& groups, uint32_t variant) {
    const auto has = [variant](ShadeVariant bit) -> uint32_t { return variant & bit ? 1 : 0; };
    return kernels.get(kShade, {groups.width, groups.height, groups.rows, has(kEveryLamp), has(kCones), has(kPowers),
                                has(kTables), has(kListed), has(kMerged), has(kGlossy), has(kRoads), has(kRetro),
                                has(kMaps), has(kLookups), has(kClipmaps)});
}

// What is in the blocks of a class, as bits of a shading kernel, beside the lamps that the frame has.
struct BlockClass {
    const char* name;
    uint32_t variant;
};
constexpr std::array<BlockClass, shared::kBlockClasses> kClasses{{
    {"shade empty", 0},
    {"shade matt", kMerged},
    {"shade matt listed", kMerged | kListed},
    {"shade paved", kMerged | kRoads},
    {"shade paved listed", kMerged | kRoads | kListed},
    {"shade glossy", kGlossy | kListed},
    {"shade glossy paved", kGlossy | kRoads | kListed},
    {"shade retro", kRetro | kGlossy | kListed},
}};

}  // namespace

graph::Resource add_shading(const FrameContext& frame, const GBuffer& g, const Clusters& clusters, const Blocks& blocks,
                            const ShadeSettings& settings) {
    const PixelGroups groups = pixel_groups(frame.kernels.device());
    shared::ShadePush push{.size = {frame.view.extent.width, frame.view.extent.height},
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
    const graph::Resource retro =
        settings.retro ? settings.retro : clusters.tables.texels;  // the binding must hold something
    const uint32_t present = frame_variant(clusters, bool(settings.retro));
    for (push.block_class = 0; push.block_class < kClasses.size(); ++push.block_class) {
        const BlockClass& c = kClasses[push.block_class];
        if (c.variant & kRoads & ~present) continue;
        // The last class has any surfaces; without classes of retroreflection a sheet is a glossy surface.
        uint32_t variant = c.variant;
        if (variant & kRetro) variant = (variant & ~uint32_t{kRetro}) | (present & (kRetro | kRoads));
        if (variant & kListed) variant |= present & (kCones | kPowers | kTables);
        if (variant & kListed && settings.all_lamps) variant |= kEveryLamp;
        if (variant & kListed && settings.maps.lamps)
            variant |= kMaps | (settings.all_lamps || c.variant & kRetro ? uint32_t{kLookups} : 0u);
        if (blocks.directional_shares) variant |= kClipmaps;
        frame.graph.dispatch(
            c.name, shade_kernel(frame.kernels, groups, variant),
            {load(g.reflectance), load(g.surface), update(g.emission), sample(clusters.lamps), sample(blocks.counts),
             sample(blocks.entries), sample(clusters.tables.texels), sample(retro), sample(blocks.sums),
             sample(blocks.class_counts), sample(blocks.class_blocks),
             sample(settings.maps.lamps ? settings.maps.lamps : clusters.lamps),
             sample(settings.maps.lamps ? settings.maps.distances : clusters.lamps),
             sample(settings.maps.lamps ? blocks.shares : blocks.entries),
             sample(blocks.directional_shares ? blocks.directional_shares : blocks.entries), sample(clusters.counts),
             sample(clusters.indices), sample(clusters.block_slices)},
            push,
            graph::Arguments{blocks.class_counts, uint64_t(push.block_class) * shared::kClassWords * sizeof(uint32_t)});
    }
    return g.emission;
}

}  // namespace vesper::render
