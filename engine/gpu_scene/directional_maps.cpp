#include "gpu_scene/directional_maps.h"

#include <algorithm>
#include <cmath>

namespace vesper::gpu_scene {

DirectionalPlan directional_plan(uint32_t lamps) {
    DirectionalPlan plan{.lamps = lamps};
    if (lamps == 0) return plan;
    plan.side = kMostDirectionalSide;
    while (plan.side >= kLeastDirectionalSide && plan.texels() > kMostDirectionalTexels) plan.side /= 2;
    if (plan.side < kLeastDirectionalSide) plan.side = 0;
    return plan;
}

DirectionalPlan directional_plan(std::span<const PlacedLamp> lamps) {
    return directional_plan(uint32_t(std::ranges::count_if(
        lamps, [](const PlacedLamp& placed) { return placed.lamp.kind == scene::Lamp::Kind::Directional; })));
}

uint32_t levels_for(const GpuScene& scene, std::span<const glm::dmat4> world, glm::dvec3 eye, double angle) {
    constexpr double kReaches = 0.92;  // of the half width of a level, from the eye
    double away = 0;
    for (const GpuScene::Placement& placement : scene.placements())
        for (uint32_t i = placement.first_part; i < placement.first_part + placement.part_count; ++i) {
            const WorldSphere sphere = world_sphere_of(scene.parts()[i], world[placement.node]);
            away = std::max(away, glm::distance(eye, sphere.centre) + sphere.radius);
        }
    away += std::tan(angle / 2) * double(shared::kDirectionalReach);
    uint32_t levels = 1;
    while (levels < shared::kDirectionalLevels && away > kReaches * half_width_of(levels - 1)) ++levels;
    return levels;
}

double half_width_of(uint32_t level) { return std::ldexp(double(shared::kFirstHalfWidth), int(level)); }

glm::dvec3 middle_of(const glm::dmat3& rotation, glm::dvec3 eye, uint32_t level) {
    const double step = double(shared::kLevelStep) * half_width_of(level);
    return glm::round(rotation * eye / step) * step;
}

shared::DirectionalMap directional_map(const DirectionalPlan& plan, uint32_t number, const glm::dmat3& rotation,
                                       double angle, const View& view) {
    shared::DirectionalMap map{
        .turn = turn_to_map(rotation, view),
        .first = float(number * shared::kDirectionalLevels * plan.texels_of_level() / shared::kMapUnit),
        .radius = float(std::tan(angle / 2)),
        .unused_a = 0,
        .unused_b = 0,
        .middle = {}};
    const glm::dvec3 eye = eye_of(view), from = rotation * eye;
    for (uint32_t level = 0; level < shared::kDirectionalLevels; ++level)
        map.middle[level] = glm::vec4(glm::vec3(middle_of(rotation, eye, level) - from), 0);
    return map;
}

}  // namespace vesper::gpu_scene
