#include "render/passes/targets.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "shaders/targets/targets.comp.inc"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store;

constexpr gpu::Shader kTargets{"targets.comp", targets_comp, targets_comp_storage};

}  // namespace

shared::TargetRect target_rect(glm::dvec2 low, glm::dvec2 high, VkExtent2D picture) {
    const glm::dvec2 size(picture.width, picture.height), sides = high - low;
    const bool seen = glm::all(glm::lessThan(low, size)) && glm::all(glm::greaterThan(high, glm::dvec2(0)));
    if (!seen) return {.first = {0, 0}, .end = {0, 0}, .stride = 1};
    const double frame = std::max(kLeastFrame, std::ceil(0.5 * std::min(sides.x, sides.y)));
    const glm::uvec2 first(glm::clamp(glm::floor(low) - frame, glm::dvec2(0), size)),
        end(glm::clamp(glm::ceil(high) + frame, glm::dvec2(0), size));
    const auto read = [&](uint32_t stride) {
        const glm::uvec2 pixels = (end - first + stride - 1u) / stride;
        return uint64_t{pixels.x} * pixels.y;
    };
    uint32_t stride = 1;
    while (read(stride) > shared::kMostTargetSamples) ++stride;
    return {first, end, stride};
}

graph::Resource add_targets(const FrameContext& frame, const TargetImages& images, const TargetPixels& targets) {
    if (targets.rects.empty()) return {};
    if (targets.rects.size() > shared::kMostTargets)
        throw Error(std::to_string(targets.rects.size()) + " targets are more than " +
                    std::to_string(shared::kMostTargets));
    std::vector<uint32_t> of_instances = targets.of_instances;
    if (of_instances.empty()) of_instances.push_back(0);  // an upload is never empty
    const gpu_scene::View& view = frame.view;
    const shared::TargetsPush push{{view.extent.width, view.extent.height}, view.ray_scale(), view.ray_offset()};
    const auto count = uint32_t(targets.rects.size());
    const graph::Resource sums =
        frame.graph.transient("sums of targets", graph::buffer_shape(count * sizeof(shared::TargetSums)));
    frame.graph.dispatch("targets", frame.kernels.get(kTargets),
                         {load(images.triangle), load(images.scene), load(images.retina), load(images.whole),
                          sample(frame.graph.upload("targets of instances", of_instances, VK_FORMAT_R32_UINT)),
                          load(frame.graph.upload("rectangles of targets", targets.rects)), store(sums)},
                         push, graph::Groups{count, 1, 1});
    return sums;
}

}  // namespace vesper::render
