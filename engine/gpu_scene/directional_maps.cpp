#include "gpu_scene/directional_maps.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

namespace vesper::gpu_scene {

DirectionalPlan directional_plan(uint32_t lamps, double extent) {
    DirectionalPlan plan{.lamps = lamps};
    constexpr double kReaches = 0.92;  // of the half width of a level, from the eye
    while (plan.levels < shared::kDirectionalLevels && extent > kReaches * half_width_of(plan.levels - 1))
        ++plan.levels;
    if (lamps == 0) return plan;
    plan.side = kMostDirectionalSide;
    while (plan.side >= kLeastDirectionalSide && plan.texels() > kMostDirectionalTexels) plan.side /= 2;
    if (plan.side < kLeastDirectionalSide) plan.side = 0;
    return plan;
}

double extent_of(const GpuScene& scene, std::span<const glm::dmat4> world) {
    glm::dvec3 low(1e300), high(-1e300);
    for (const GpuScene::Placement& placement : scene.placements())
        for (uint32_t i = placement.first_part; i < placement.first_part + placement.part_count; ++i) {
            const WorldSphere sphere = world_sphere_of(scene.parts()[i], world[placement.node]);
            low = glm::min(low, sphere.centre - sphere.radius), high = glm::max(high, sphere.centre + sphere.radius);
        }
    return low.x > high.x ? 0 : glm::distance(low, high);
}

double half_width_of(uint32_t level) { return std::ldexp(double(shared::kFirstHalfWidth), int(level)); }

glm::dvec3 middle_of(const glm::dmat3& rotation, glm::dvec3 eye, uint32_t level) {
    const double step = double(shared::kLevelStep) * half_width_of(level);
    return glm::round(rotation * eye / step) * step;
}

shared::DirectionalMap directional_map(const DirectionalPlan& plan, uint32_t number, const glm::dmat3& rotation,
                                       double angle, const View& view) {
    const glm::dquat turn = glm::normalize(glm::quat_cast(rotation * glm::transpose(glm::dmat3(view.world_to_view))));
    shared::DirectionalMap map{.turn = glm::vec4(float(turn.x), float(turn.y), float(turn.z), float(turn.w)),
                               .first = float(number * plan.levels * plan.texels_of_level() / shared::kMapUnit),
                               .radius = float(std::tan(angle / 2)),
                               .unused_a = 0,
                               .unused_b = 0,
                               .middle = {}};
    const glm::dvec3 eye = eye_of(view), from = rotation * eye;
    for (uint32_t level = 0; level < plan.levels; ++level)
        map.middle[level] = glm::vec4(glm::vec3(middle_of(rotation, eye, level) - from), 0);
    return map;
}

glm::dvec3 eye_of(const View& view) { return glm::dvec3(glm::inverse(view.world_to_view)[3]); }

}  // namespace vesper::gpu_scene
