#include "render/shadows/moving_placements.h"

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

// A sphere around the box around the spheres of the parts.
MovingPlacements::Moving MovingPlacements::at_pose(uint32_t placement, const glm::dmat4& world) const {
    const gpu_scene::GpuScene::Placement& of = scene_.placements()[placement];
    std::vector<gpu_scene::WorldSphere> spheres;
    glm::dvec3 low(1e300), high(-1e300);
    for (uint32_t i = of.first_part; i < of.first_part + of.part_count; ++i) {
        const gpu_scene::WorldSphere sphere = gpu_scene::world_sphere_of(scene_.parts()[i], world);
        low = glm::min(low, sphere.centre - sphere.radius), high = glm::max(high, sphere.centre + sphere.radius);
        spheres.push_back(sphere);
    }
    double radius = 0;
    const glm::dvec3 centre = 0.5 * (low + high);
    for (const gpu_scene::WorldSphere& sphere : spheres)
        radius = std::max(radius, glm::distance(centre, sphere.centre) + sphere.radius);
    return {placement, version_, centre, radius};
}

}  // namespace vesper::render
