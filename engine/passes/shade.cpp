#include <array>

#include "passes/passes.h"
#include "shared/gather.h"

namespace vesper {
namespace {

constexpr uint32_t kBlockCapacity = 256;  // lights of a block of pixels; more, and it looks at every light
constexpr float kTolerance = 2e-3f;       // relative error of a lamp that is added up over a block

constexpr uint64_t kWord = sizeof(uint32_t);
constexpr VkFormat kWords = VK_FORMAT_R32_UINT;

// What is in the blocks of a class, as bits of a shading kernel, beside what the frame has.
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
    {"shade retro", Kernels::kRetro | Kernels::kGlossy | Kernels::kRoads | Kernels::kListed},
}};

// A class's words of the counts: no blocks yet.
std::vector<uint32_t> empty_classes() {
    std::vector<uint32_t> words;
    for (uint32_t k = 0; k < shared::kBlockClasses; ++k) words.insert(words.end(), {0, 1, 1, 0});
    static_assert(shared::kClassWords == 4);
    return words;
}

}  // namespace

Resource add_shading(FrameGraph& graph, const Kernels& kernels, const GBuffer& g, const Clusters& clusters, const View& view, const ShadeSettings& settings) {
    const Groups block_grid = cover(view.extent.width, view.extent.height, shared::kBlockSize, shared::kBlockSize);
    const uint32_t blocks = block_grid.x * block_grid.y;
    const glm::uvec2 pixels{view.extent.width, view.extent.height};
    const shared::LightCounts& lights = clusters.push.lights;

    uint32_t frame = 0;  // what it has
    if (lights.cones) frame |= Kernels::kCones;
    if (lights.powers) frame |= Kernels::kPowers;
    if (lights.maps) frame |= Kernels::kMaps;
    if (clusters.maps.has_roads) frame |= Kernels::kRoads;
    if (settings.retro) frame |= Kernels::kRetro;

    const auto words = [&](const char* name, uint64_t count) { return graph.transient(name, buffer_shape(count * kWord, kWords)); };
    const Resource counts = words("block counts", blocks * 2), entries = words("block entries", uint64_t(blocks) * kBlockCapacity);
    const Kernel& select = kernels.select(frame);
    graph.dispatch("select", select,
                   {load(g.surface), sample(clusters.lights), sample(clusters.counts), sample(clusters.indices), store(counts), store(entries), sample(clusters.maps.texels)},
                   shared::SelectPush{clusters.push, pixels, block_grid.x, kBlockCapacity},
                   cover(block_grid.x, block_grid.y, select.group[0], select.group[1]));

    const Resource no_blocks = graph.upload("no blocks", empty_classes(), kWords);
    const Resource class_counts = words("class counts", shared::kBlockClasses * shared::kClassWords);
    const Resource class_blocks = words("class blocks", uint64_t(blocks) * shared::kBlockClasses);
    const Resource sums = graph.transient("block sums", buffer_shape(uint64_t(blocks) * shared::kGatherTexels * sizeof(glm::vec4), VK_FORMAT_R32G32B32A32_SFLOAT));
    graph.copy("begin classes", no_blocks, class_counts);
    const Kernel& gather = kernels.gather(frame);
    graph.dispatch("gather", gather,
                   {load(g.reflectance), load(g.surface), sample(clusters.lights), update(counts), update(entries), store(sums), sample(clusters.maps.texels),
                    update(class_counts), store(class_blocks)},
                   shared::GatherPush{.view = clusters.push, .size = pixels, .blocks_x = block_grid.x, .blocks_y = block_grid.y, .capacity = kBlockCapacity,
                                      .roads = clusters.maps.roads, .tolerance = settings.all_lights ? -1 : kTolerance},
                   cover(block_grid.x, block_grid.y, gather.group[0], 1));

    shared::ShadePush push{.size = pixels,
                           .grid = clusters.push.grid,
                           .lights = lights,
                           .threshold = clusters.push.threshold,
                           .lambert = settings.lambert,
                           .emission_limit = settings.emission_limit,
                           .ambient = settings.ambient,
                           .sky = settings.sky,
                           .blocks_x = block_grid.x,
                           .capacity = kBlockCapacity,
                           .roads = clusters.maps.roads,
                           .blocks = blocks,
                           .block_class = 0};
    const Resource retro = settings.retro ? settings.retro : clusters.maps.texels;  // the binding must hold something
    constexpr uint32_t kSurfaces = Kernels::kRoads | Kernels::kRetro;  // of which a class without them needs none
    for (const BlockClass& c : kClasses) {
        if ((c.variant & Kernels::kRetro & ~frame) || (!(c.variant & Kernels::kRetro) && (c.variant & Kernels::kRoads & ~frame))) {
            ++push.block_class;
            continue;
        }
        uint32_t variant = (c.variant & ~kSurfaces) | (c.variant & frame & kSurfaces);
        if (c.variant & Kernels::kListed) variant |= frame & (Kernels::kCones | Kernels::kPowers | Kernels::kMaps);
        if (c.variant & Kernels::kListed && settings.all_lights) variant |= Kernels::kEveryLight;
        const Arguments groups{class_counts, push.block_class * shared::kClassWords * kWord};
        graph.dispatch(c.name, kernels.shade(variant),
                       {load(g.reflectance), load(g.surface), update(g.emission), sample(clusters.lights), sample(counts), sample(entries), sample(clusters.maps.texels),
                        sample(retro), sample(sums), sample(class_counts), sample(class_blocks)},
                       push, groups);
        ++push.block_class;
    }
    return g.emission;
}

}  // namespace vesper
