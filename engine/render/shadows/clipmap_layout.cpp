#include "render/shadows/clipmap_layout.h"

#include <algorithm>
#include <cmath>

namespace vesper::render {

ClipmapPlan clipmap_plan(uint32_t lamps) {
    ClipmapPlan plan{.lamps = lamps};
    if (lamps == 0) return plan;
    plan.side = kMostClipmapSide;
    while (plan.side >= kLeastClipmapSide && plan.texels() > kMostClipmapTexels) plan.side /= 2;
    if (plan.side < kLeastClipmapSide) plan.side = 0;
    return plan;
}

ClipmapPlan clipmap_plan(std::span<const gpu_scene::PlacedLamp> lamps) {
    return clipmap_plan(uint32_t(std::ranges::count_if(lamps, [](const gpu_scene::PlacedLamp& placed) {
        return placed.lamp.kind == scene::Lamp::Kind::Directional;
    })));
}

uint32_t levels_for(const gpu_scene::GpuScene& scene, std::span<const glm::dmat4> world, glm::dvec3 eye, double angle) {
    constexpr double kReaches = 0.92;  // of the half width of a level, from the eye
    double away = 0;
    for (const gpu_scene::GpuScene::Placement& placement : scene.placements())
        for (uint32_t i = placement.first_part; i < placement.first_part + placement.part_count; ++i) {
            const gpu_scene::WorldSphere sphere = gpu_scene::world_sphere_of(scene.parts()[i], world[placement.node]);
            away = std::max(away, glm::distance(eye, sphere.centre) + sphere.radius);
        }
    away += std::tan(angle / 2) * double(shared::kPenumbraReach);
    uint32_t levels = 1;
    while (levels < shared::kClipmapLevels && away > kReaches * level_half_width(levels - 1)) ++levels;
    return levels;
}

double level_half_width(uint32_t level) { return std::ldexp(double(shared::kFirstHalfWidth), int(level)); }

glm::dvec3 level_middle(const glm::dmat3& rotation, glm::dvec3 eye, uint32_t level) {
    const double step = double(shared::kLevelStep) * level_half_width(level);
    return glm::round(rotation * eye / step) * step;
}

shared::Clipmap clipmap(const ClipmapPlan& plan, uint32_t number, const glm::dmat3& rotation, double angle,
                        const gpu_scene::View& view) {
    shared::Clipmap map{.rotation = rotation_to_map(rotation, view),
                        .first = float(number * shared::kClipmapLevels * plan.texels_of_level() / shared::kMapUnit),
                        .radius = float(std::tan(angle / 2)),
                        .unused_a = 0,
                        .unused_b = 0,
                        .middle = {}};
    const glm::dvec3 eye = gpu_scene::eye_of(view), from = rotation * eye;
    for (uint32_t level = 0; level < shared::kClipmapLevels; ++level)
        map.middle[level] = glm::vec4(glm::vec3(level_middle(rotation, eye, level) - from), 0);
    return map;
}

}  // namespace vesper::render
