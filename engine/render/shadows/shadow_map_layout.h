// The layout of shadow maps: sides, projections, and the tiles that see something. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/lamps.h"
#include "shared/shadow_map.h"

namespace vesper::scene {
struct Scene;
}

namespace vesper::render {

constexpr double kFaintestLight = 0.01;  ///< lx: light below casts no shadow

/// The shadow map of a lamp (shared/shadow_map.h).
struct ShadowMapLayout {
    uint32_t side = 0;         ///< texels; 0: the lamp has no map, nothing hides it
    uint32_t hemispheres = 1;  ///< 1: about its axis; 2: all directions
    float zoom = 1;            ///< the share of the hemisphere's square that the map has is its inverse
    bool flat = false;         ///< a map for a narrow beam: one perspective projection
    float range = 0;           ///< m: no farther surface is a caster
    float radius = 0;          ///< of a disc of the area of its opening, m; 0 without
    uint32_t first = 0;        ///< texel, a multiple of shared::kMapUnit
    bool moves = false;        ///< with its lamp: drawn in each frame, with half the side

    uint32_t texels() const { return hemispheres * side * side; }
};

/// The maps of all lamps of a scene, in the order of placed_lamps().
struct ShadowMapPlan {
    std::vector<ShadowMapLayout> layouts;  ///< without sides and places, which depend on the view
    std::vector<glm::dvec3> places;        ///< of the lamps at the start, m, world
    /// For each lamp the placements that belong to its fixture and never hide it (scene/fixtures.h), ascending.
    std::vector<std::vector<uint32_t>> fixtures;
    std::vector<bool> animated;  ///< per node, whether the scene's animations move it
};
ShadowMapPlan shadow_map_plan(const scene::Scene& scene, const gpu_scene::GpuScene& resident,
                              const std::vector<gpu_scene::PlacedLamp>& lamps);

constexpr uint32_t kLeastMapSide = shared::kRegion, kMostMapSide = 2048;  ///< texels
/// Sets the sides of maps that an eye at these distances (m) sees: powers of two within the limits above, nearest to
/// 2^scale I^1/4 / (sqrt(distance) zoom), I the largest intensity, distances of at least 4 m; half of these for lamps
/// that move; 0 for lamps without a map. Where these take more than `most_texels` the scale is less by steps of 1/64.
/// Returns it. Maps that do not fit at the least side, see least_texels(), have that.
double choose_sides(std::vector<ShadowMapLayout>& layouts, const std::vector<double>& distances, double scale,
                    uint64_t most_texels);
/// Of maps that have all the least side.
uint64_t least_texels(const std::vector<ShadowMapLayout>& layouts);
/// The largest scale, up to a limit, at which the maps of a scene take at most `most_texels` seen from its lamps: so
/// that sides change with the distance of the eye alone.
double scene_scale(const ShadowMapPlan& plan, uint64_t most_texels);

/// A frame of axes that a map is drawn in: z along the axis of its first hemisphere.
struct MapFrame {
    glm::dvec3 position{0};  ///< m, world
    glm::dmat3 rotation{1};  ///< from the world's axes to the map's: rows are its x, y and z
};
/// Of a lamp at a node of this pose.
MapFrame map_frame(const glm::dmat4& world);

/// Signs of x and y of the quadrants that a hemisphere is drawn in one by one; zeros of a flat map.
std::span<const glm::dvec2> quadrants_of(const ShadowMapLayout& layout);
/// Whether the square of a hemisphere with this zoom may see something of a sphere, within the quadrant of x and y of
/// these signs; 0 for a flat map. The sphere is in the frame of the map, z mirrored for the second hemisphere, m. Never
/// false where it is seen.
bool may_see(double zoom, glm::dvec2 signs, glm::dvec3 centre, double radius);

/// The quaternion from the frame of a view to that of a map with this rotation, as shaders take it.
glm::vec4 rotation_to_map(const glm::dmat3& rotation, const gpu_scene::View& view);
/// The map of a lamp, as shaders see it in a frame of `view`.
shared::ShadowMap shadow_map(const ShadowMapLayout& layout, const MapFrame& frame, const gpu_scene::View& view);

}  // namespace vesper::render
