#include "render/shadows/clipmaps.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "render/shadows/caster_parts.h"

namespace vesper::render {

Clipmaps::Clipmaps(const gpu::Device& device, const gpu_scene::GpuScene& resident,
                   const std::vector<gpu_scene::PlacedLamp>& lamps, const ClipmapPlan& plan)
    : resident_(resident),
      lamps_(lamps),
      plan_(plan),
      first_(uint32_t(lamps.size()) - plan.lamps),
      arena_(device),
      levels_(plan.lamps * shared::kClipmapLevels) {
    if (plan.lamps == 0) return;
    if (plan.side == 0)
        throw Error("shadows of " + std::to_string(plan.lamps) + " directional lights take clipmaps of more than " +
                    std::to_string(kMostClipmapTexels) + " texels; without shadows the scene can be rendered");
    distances_ = make_shadow_texels(device, arena_, plan.texels());
}

uint32_t Clipmaps::plan(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses,
                        const gpu_scene::View& view) {
    to_draw_.clear();
    if (list.counts.directional == 0) return 0;
    std::vector<glm::dmat4> placed;
    for (const gpu_scene::GpuScene::Placement& placement : resident_.placements())
        placed.push_back(poses.world[placement.node]);
    if (placed_ != placed) {
        std::ranges::fill(levels_, Level{});
        placed_ = std::move(placed);
    }
    const glm::dvec3 eye = gpu_scene::eye_of(view);
    double angle = 0;
    for (uint32_t i = list.placed(); i < list.lamps.size(); ++i)
        angle = std::max(angle, double(lamps_[list.indices[i]].lamp.angular_diameter));
    used_ = levels_for(resident_, poses.world, eye, angle);
    for (uint32_t i = list.placed(); i < list.lamps.size(); ++i) {
        const uint32_t number = list.indices[i] - first_;
        const glm::dmat3 rotation = map_frame(poses.world[lamps_[list.indices[i]].node]).rotation;
        for (uint32_t k = 0; k < used_; ++k) {
            const Level wanted{rotation, level_middle(rotation, eye, k)};
            const uint32_t at = number * shared::kClipmapLevels + k;
            if (levels_[at] == wanted) continue;
            levels_[at] = wanted;
            to_draw_.push_back({rotation, wanted.middle, level_half_width(k), at * plan_.texels_of_level()});
        }
    }
    return uint32_t(to_draw_.size());
}

void Clipmaps::forget() {
    std::ranges::fill(levels_, Level{});
    to_draw_.clear();
}

FrameClipmaps Clipmaps::declare(const FrameContext& frame, const gpu_scene::LampList& list,
                                const gpu_scene::SceneFrame& poses, const gpu_scene::View& view) {
    if (plan_.lamps == 0) return {};
    graph::FrameGraph& graph = frame.graph;
    const graph::Resource distances =
        graph.persistent("directional distances", distances_, plan_.texels() * sizeof(uint16_t), VK_FORMAT_R16_SFLOAT);
    add_clipmaps(frame, resident_, poses, to_draw_, plan_.side, distances, add_level_scratch(graph, plan_.side));
    to_draw_.clear();
    std::vector<shared::Clipmap> lamps;
    for (uint32_t i = list.placed(); i < list.lamps.size(); ++i) {
        const gpu_scene::PlacedLamp& placed = lamps_[list.indices[i]];
        const glm::dmat3 rotation = map_frame(poses.world[placed.node]).rotation;
        lamps.push_back(clipmap(plan_, list.indices[i] - first_, rotation, double(placed.lamp.angular_diameter), view));
    }
    if (lamps.empty()) return {};
    return {graph.upload("clipmaps", lamps, VK_FORMAT_R32G32B32A32_SFLOAT), distances, used_, plan_.side};
}

}  // namespace vesper::render
