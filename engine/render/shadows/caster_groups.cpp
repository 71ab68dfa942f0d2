#include "render/shadows/caster_groups.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

namespace vesper::render {

using gpu_scene::GpuScene, gpu_scene::PlacedPart, gpu_scene::WorldSphere;

namespace {

// Around the box around spheres, at least one.
WorldSphere sphere_around(std::span<const WorldSphere> spheres) {
    glm::dvec3 low(1e300), high(-1e300);
    for (const auto& [centre, radius] : spheres)
        low = glm::min(low, centre - radius), high = glm::max(high, centre + radius);
    WorldSphere around{0.5 * (low + high), 0};
    for (const auto& [centre, radius] : spheres)
        around.radius = std::max(around.radius, glm::distance(around.centre, centre) + radius);
    return around;
}

}  // namespace

CasterBounds caster_bounds(const GpuScene& scene, uint32_t placement, const glm::dmat4& world) {
    const GpuScene::Placement& of = scene.placements()[placement];
    CasterBounds bounds;
    bounds.parts.reserve(of.part_count);
    for (uint32_t i = 0; i < of.part_count; ++i)
        bounds.parts.push_back(gpu_scene::world_sphere_of(scene.parts()[of.first_part + i], world));
    if (!bounds.parts.empty()) bounds.whole = sphere_around(bounds.parts);
    return bounds;
}

CasterGroups::CasterGroups(const GpuScene& scene, std::span<const uint32_t> still, const gpu_scene::SceneFrame& poses)
    : stands_(scene.placements().size()), bounds_(scene.placements().size()) {
    std::vector<bool> at_rest(scene.placements().size());
    std::vector<PlacedPart> all, in_cells;
    for (const uint32_t p : still) {
        const GpuScene::Placement& placement = scene.placements()[p];
        const glm::dmat4& world = poses.world[placement.node];
        stands_[p] = true, at_rest[p] = world == placement.at_rest;
        bounds_[p] = caster_bounds(scene, p, world);
        for (uint32_t i = 0; i < placement.part_count; ++i) all.push_back({p, placement.first_part + i});
    }
    std::vector<Caster> casters;
    for (const GpuScene::Cell& cell : scene.cells()) {
        if (!std::ranges::all_of(cell.parts, [&](const PlacedPart& part) { return at_rest[part.placement]; })) continue;
        casters.push_back({{cell.centre, cell.radius}, &cell, cell.parts});
        in_cells.insert(in_cells.end(), cell.parts.begin(), cell.parts.end());
    }
    std::ranges::sort(in_cells);
    std::ranges::set_difference(all, in_cells, std::back_inserter(loose_));
    for (auto begin = loose_.begin(); begin != loose_.end();) {
        const uint32_t p = begin->placement;
        const auto end = std::find_if(begin, loose_.end(), [&](const PlacedPart& part) { return part.placement != p; });
        casters.push_back({bounds_[p].whole, nullptr, {begin, end}});
        begin = end;
    }
    add_groups(casters);
}

// By cubes that their middles lie in; large ones alone.
void CasterGroups::add_groups(const std::vector<Caster>& casters) {
    constexpr double kSide = 4 * gpu_scene::kCellSide, kHair = 1e-6;  // m; over all rounding
    std::map<std::array<double, 4>, std::vector<Caster>> by_place;
    for (const Caster& caster : casters) {
        const glm::dvec3 cube = glm::floor(caster.bounds.centre / kSide);
        const double alone = caster.bounds.radius > kSide ? 1 + double(&caster - casters.data()) : 0;
        by_place[{alone, cube.x, cube.y, cube.z}].push_back(caster);
    }
    for (auto& [place, of] : by_place) {
        std::vector<WorldSphere> spheres;
        for (const Caster& caster : of) spheres.push_back(caster.bounds);
        WorldSphere bounds = sphere_around(spheres);
        bounds.radius += kHair * (1 + bounds.radius);
        groups_.push_back({bounds, std::move(of)});
    }
}

}  // namespace vesper::render
