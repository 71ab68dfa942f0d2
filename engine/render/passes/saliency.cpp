#include "render/passes/saliency.h"

#include <algorithm>
#include <string>

#include "shaders/saliency/combine.comp.inc"
#include "shaders/saliency/contrast.comp.inc"
#include "shaders/saliency/levels.comp.inc"
#include "shaders/saliency/oriented.comp.inc"
#include "shaders/saliency/promote.comp.inc"
#include "shared/saliency.h"

namespace vesper::render {
namespace {

using graph::Resource, graph::load, graph::store;

constexpr gpu::Shader kLevels{"levels.comp", levels_comp}, kOriented{"oriented.comp", oriented_comp},
    kContrast{"contrast.comp", contrast_comp}, kPromote{"promote.comp", promote_comp},
    kCombine{"combine.comp", combine_comp};

glm::uvec2 size_of(VkExtent2D extent) { return {extent.width, extent.height}; }

VkExtent2D level_extent(VkExtent2D extent, uint32_t level) {
    const auto texels = [level](uint32_t pixels) { return (pixels + (1u << level) - 1) >> level; };
    return {texels(extent.width), texels(extent.height)};
}

/// A level of the scene.
struct Level {
    Resource light, oriented;
    VkExtent2D extent;
};

Level add_level(const FrameContext& frame, Resource from, VkExtent2D from_extent, uint32_t level) {
    const std::string number = std::to_string(level);
    const VkExtent2D extent = level_extent(frame.view.extent, level);
    const graph::Shape shape = graph::image_shape(kSceneFormat, extent);
    const Level made{frame.graph.transient("saliency level " + number, shape),
                     frame.graph.transient("saliency oriented " + number, shape), extent};
    const gpu::Kernel& levels = frame.kernels.get(kLevels, {level == shared::kSaliencyFinest});
    frame.graph.dispatch("saliency level " + number, levels, {load(from), store(made.light)},
                         shared::SaliencyLevelPush{size_of(from_extent), size_of(extent)},
                         graph::cover(extent.width, extent.height, levels.group[0], 1));
    const gpu::Kernel& oriented = frame.kernels.get(kOriented);
    frame.graph.dispatch("saliency oriented " + number, oriented, {load(made.light), store(made.oriented)},
                         shared::OrientedPush{size_of(extent)},
                         graph::cover(extent.width, extent.height, oriented.group[0], 1));
    return made;
}

/// The sums of `rows` rows of `columns` maps, one below the other: `sums` of them.
Resource add_up(const FrameContext& frame, Resource maps, VkExtent2D extent, uint32_t columns, uint32_t rows,
                uint32_t adds, uint32_t sums) {
    const uint32_t count = columns * rows;
    const std::string number = std::to_string(adds);
    const shared::SaliencyMapsPush push{size_of(extent), columns};
    const Resource factors =
        frame.graph.transient("saliency factors " + number, graph::image_shape(kSceneFormat, {count, 1}));
    frame.graph.dispatch("saliency promote " + number, frame.kernels.get(kPromote), {load(maps), store(factors)}, push,
                         graph::Groups{count, 1, 1});
    const gpu::Kernel& combine = frame.kernels.get(kCombine, {adds});
    const Resource made = frame.graph.transient("saliency sums " + number,
                                                graph::image_shape(kSceneFormat, {extent.width, sums * extent.height}));
    frame.graph.dispatch("saliency combine " + number, combine, {load(maps), load(factors), store(made)}, push,
                         graph::cover(extent.width, extent.height, combine.group[0], 1));
    return made;
}

}  // namespace

std::vector<SaliencyPair> saliency_pairs(VkExtent2D extent) {
    std::vector<SaliencyPair> pairs;
    for (uint32_t centre = shared::kSaliencyFinest; centre <= shared::kSaliencyMapLevel; ++centre)
        for (uint32_t surround = centre + 3; surround <= centre + 4; ++surround)
            if (std::min(extent.width, extent.height) >> surround > 0) pairs.push_back({centre, surround});
    return pairs;
}

Saliency add_saliency(const FrameContext& frame, Resource scene) {
    const std::vector<SaliencyPair> pairs = saliency_pairs(frame.view.extent);
    if (pairs.empty()) return {};
    std::vector<Level> levels;
    const auto highest = std::ranges::max(pairs, {}, &SaliencyPair::surround).surround;
    for (uint32_t level = shared::kSaliencyFinest; level <= highest; ++level)
        levels.push_back(levels.empty() ? add_level(frame, scene, frame.view.extent, level)
                                        : add_level(frame, levels.back().light, levels.back().extent, level));

    const VkExtent2D extent = level_extent(frame.view.extent, shared::kSaliencyMapLevel);
    const auto count = uint32_t(pairs.size());
    const Resource maps = frame.graph.transient(
        "saliency maps", graph::image_shape(kSceneFormat, {count * extent.width, 3 * extent.height}));
    const gpu::Kernel& contrast = frame.kernels.get(kContrast);
    for (uint32_t i = 0; i < count; ++i) {
        const Level &centre = levels[pairs[i].centre - shared::kSaliencyFinest],
                    &surround = levels[pairs[i].surround - shared::kSaliencyFinest];
        frame.graph.dispatch("saliency contrast " + std::to_string(i), contrast,
                             {load(centre.light), load(centre.oriented), load(surround.light), load(surround.oriented),
                              i == 0 ? store(maps) : graph::update(maps)},
                             shared::ContrastPush{size_of(extent), size_of(centre.extent), size_of(surround.extent),
                                                  1u << (shared::kSaliencyMapLevel - pairs[i].centre),
                                                  1.0f / float(1u << (pairs[i].surround - pairs[i].centre)), i},
                             graph::cover(extent.width, extent.height, contrast.group[0], 1));
    }
    const Resource of_pairs = add_up(frame, maps, extent, count, 3, shared::kAddPairs, 2),
                   conspicuities = add_up(frame, of_pairs, extent, 1, 2, shared::kAddOrientations, 1);
    return {add_up(frame, conspicuities, extent, 1, 1, shared::kAddConspicuities, 1), extent};
}

}  // namespace vesper::render
