#include "render/moving_placements.h"

#include <algorithm>

namespace vesper::render {

std::vector<uint32_t> MovingPlacements::update(const gpu_scene::SceneFrame& poses) {
    const bool first = world_.empty();
    bool moved = first;
    for (uint32_t node = 0; node < moves_.size(); ++node) {
        const bool elsewhere = !first && poses.world[node] != world_[node];
        if (elsewhere || (!poses.moving.empty() && poses.moving[node])) moves_[node] = true;
        moved = moved || elsewhere;
    }
    if (moved) ++version_;
    std::vector<uint32_t> begun;
    std::vector<uint32_t> still;
    for (uint32_t p = 0; p < scene_.placements().size(); ++p) {
        const uint32_t node = scene_.placements()[p].node;
        if (!moves_[node]) {
            still.push_back(p);
            continue;
        }
        const auto known = std::ranges::lower_bound(moving_, p, {}, &Moving::placement);
        if (known != moving_.end() && known->placement == p) {
            if (poses.world[node] != world_[node]) *known = at_pose(p, poses.world[node]);
        } else {
            moving_.insert(known, at_pose(p, poses.world[node]));
            if (!first) begun.push_back(p);
        }
    }
    still_ = std::move(still);
    world_ = poses.world;
    return begun;
}

MovingPlacements::Moving MovingPlacements::at_pose(uint32_t placement, const glm::dmat4& world) const {
    const gpu_scene::GpuScene::Placement& of = scene_.placements()[placement];
    glm::dvec3 low(1e300), high(-1e300);
    for (uint32_t i = of.first_part; i < of.first_part + of.part_count; ++i) {
        const gpu_scene::GpuScene::Part& part = scene_.parts()[i];
        const double radius = double(gpu_scene::sphere_of(part, glm::mat4(glm::dmat4(glm::dmat3(world)))).radius);
        const glm::dvec3 centre(world * glm::dvec4(part.centre, 1));
        low = glm::min(low, centre - radius), high = glm::max(high, centre + radius);
    }
    // A sphere around boxes around spheres: no more than sqrt(3) times too large.
    double radius = 0;
    const glm::dvec3 centre = 0.5 * (low + high);
    for (uint32_t i = of.first_part; i < of.first_part + of.part_count; ++i) {
        const gpu_scene::GpuScene::Part& part = scene_.parts()[i];
        const double own = double(gpu_scene::sphere_of(part, glm::mat4(glm::dmat4(glm::dmat3(world)))).radius);
        radius = std::max(radius, glm::distance(centre, glm::dvec3(world * glm::dvec4(part.centre, 1))) + own);
    }
    return {placement, version_, centre, radius};
}

}  // namespace vesper::render
