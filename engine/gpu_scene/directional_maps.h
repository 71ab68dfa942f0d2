// Where the maps of directional lamps lie (shared/directional_map.h). SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/lamp_maps.h"
#include "shared/directional_map.h"

namespace vesper::gpu_scene {

constexpr uint64_t kMostDirectionalTexels = 32u << 20u;                       ///< of all lamps: 64 MiB
constexpr uint32_t kMostDirectionalSide = 2048, kLeastDirectionalSide = 256;  ///< texels

/// Maps of all directional lamps of a scene.
struct DirectionalPlan {
    uint32_t lamps = 0;
    uint32_t side = 0;  ///< of a level, texels, a power of two; 0: there are no lamps, or too many

    uint64_t texels_of_level() const { return uint64_t(side) * side; }
    uint64_t texels() const { return lamps * shared::kDirectionalLevels * texels_of_level(); }
};
DirectionalPlan directional_plan(uint32_t lamps);
/// For those of a scene.
DirectionalPlan directional_plan(std::span<const PlacedLamp> lamps);
/// How many levels hold everything in a scene that is seen from an eye (world, m), penumbrae of lamps of this angle
/// (rad) included, if kDirectionalLevels suffice; at least 1.
uint32_t levels_for(const GpuScene& scene, std::span<const glm::dmat4> world, glm::dvec3 eye, double angle);

/// Half the side of the square of a level, m.
double half_width_of(uint32_t level);
/// The middle of a level about an eye (world, m), in the axes of the map: it moves in steps of kLevelStep half widths.
glm::dvec3 middle_of(const glm::dmat3& rotation, glm::dvec3 eye, uint32_t level);

/// The maps of a lamp of this angle (rad) as shaders see them in a frame of `view`. `number`: of the lamp among
/// directional ones.
shared::DirectionalMap directional_map(const DirectionalPlan& plan, uint32_t number, const glm::dmat3& rotation,
                                       double angle, const View& view);

}  // namespace vesper::gpu_scene
