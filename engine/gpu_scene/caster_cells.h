// Casters at rest, merged and simplified, for shadow maps far away. SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::scene {
struct Scene;
}

namespace vesper::gpu_scene {

/// A part of a placement, by their numbers in GpuScene.
struct PlacedPart {
    uint32_t placement, part;
    auto operator<=>(const PlacedPart&) const = default;
};

/// Opaque parts at rest whose middles lie in one cube of the world, or a single part that is larger than it.
struct CasterCell {
    /// Triangles in place of those of all parts.
    struct Level {
        double error;  ///< m: no farther are their surfaces from those of the parts, about
        uint32_t first_index, index_count;
    };
    std::vector<PlacedPart> parts;    ///< ascending
    glm::dvec3 origin{0};             ///< m, world: the middle of the parts
    std::vector<glm::vec3> vertices;  ///< m, from the origin
    std::vector<uint32_t> indices;    ///< of all levels, one after another
    double radius = 0;                ///< m: of a sphere around the parts
    std::vector<Level> levels;        ///< ascending by error, descending by triangles
};

constexpr double kCellSide = 8;                     ///< m
constexpr uint64_t kMostCellTriangles = 2u << 20u;  ///< at rest: a scene of more would start late

/// The cells of all nodes that no animation moves, at the poses that the scene has. Masked and clear parts are in none,
/// and no cell is a single part alone. The first level has all triangles; others are simplified by quadric error
/// metrics (Garland and Heckbert 1997, in meshoptimizer), from 0.035 m of error on, twice as much from one to the next.
/// A scene without lamps, or of more than kMostCellTriangles, has none.
std::vector<CasterCell> caster_cells(const scene::Scene& scene);

}  // namespace vesper::gpu_scene
