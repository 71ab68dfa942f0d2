// Levels of the clipmaps of directional lamps, and their places (shared/clipmap.h). SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "gpu_scene/gpu_scene.h"
#include "render/shadows/shadow_map_layout.h"
#include "shared/clipmap.h"

namespace vesper::render {

constexpr uint64_t kMostClipmapTexels = 32u << 20u;                   ///< of all lamps: 64 MiB
constexpr uint32_t kMostClipmapSide = 2048, kLeastClipmapSide = 256;  ///< texels

/// The clipmaps of all directional lamps of a scene.
struct ClipmapPlan {
    uint32_t lamps = 0;
    uint32_t side = 0;  ///< of a level, texels, a power of two; 0: there are no lamps, or too many

    uint64_t texels_of_level() const { return uint64_t(side) * side; }
    uint64_t texels() const { return lamps * shared::kClipmapLevels * texels_of_level(); }
};
ClipmapPlan clipmap_plan(uint32_t lamps);
/// For the directional ones of the lamps of a scene.
ClipmapPlan clipmap_plan(std::span<const gpu_scene::PlacedLamp> lamps);
/// How many levels hold everything in a scene that is seen from an eye (world, m), penumbrae of lamps of this angle
/// (rad) included, if kClipmapLevels suffice; at least 1.
uint32_t levels_for(const gpu_scene::GpuScene& scene, std::span<const glm::dmat4> world, glm::dvec3 eye, double angle);

/// Half the side of the square of a level, m.
double level_half_width(uint32_t level);
/// The middle of a level about an eye (world, m), in the axes of the map: it moves in steps of kLevelStep half widths.
glm::dvec3 level_middle(const glm::dmat3& rotation, glm::dvec3 eye, uint32_t level);

/// The clipmap of a lamp of this angle (rad) as shaders see it in a frame of `view`. `number`: of the lamp among
/// directional ones.
shared::Clipmap clipmap(const ClipmapPlan& plan, uint32_t number, const glm::dmat3& rotation, double angle,
                        const gpu_scene::View& view);

}  // namespace vesper::render
