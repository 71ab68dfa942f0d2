#include "render/shadows/moving_placements.h"

#include <algorithm>

#include "render/shadows/caster_groups.h"

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
    const auto [centre, radius] = caster_bounds(scene_, placement, world).whole;
    return {placement, version_, centre, radius};
}

}  // namespace vesper::render
