// Rays through the triangles of a scene, on the host: what stands between two points. SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "rays/triangles.h"

namespace vesper::rays {

class BoxHierarchy;

/// Where a ray meets a triangle.
struct Hit {
    double share = 0;                      ///< of the way from the first point to the second, in (0, 1)
    uint32_t node = 0;                     ///< that places the mesh, index into Scene::nodes
    uint32_t primitive = 0, triangle = 0;  ///< index into Mesh::primitives; corners are indices 3 triangle, + 1, + 2
    glm::dvec3 weights{0};                 ///< of the three corners, each >= 0, sum 1
};

/// The triangles of a scene in Embree's hierarchy of boxes. Queries may run in several threads at a time; the same
/// scene gives the same answers, whatever the number of threads.
///
/// Triangles stop light from both sides; those of masked materials where they are opaque (rays/opacity.h), those of
/// clear ones nowhere. Boxes are floats that never miss a triangle (rays/box_hierarchy.h); triangles are met in double,
/// so that no ray passes between two that share an edge. Corners are floats from the middle of the scene: they lie
/// within 1e-7 of their distance from it.
class RayCaster {
public:
    /// Meets nothing.
    RayCaster();
    /// The scene with its nodes at `world` (scene::world_transforms). Keeps a reference to the scene, which must stay
    /// as it is. Takes about kBytesPerTriangle at most, and the time and memory of a Budget. Throws Error if
    /// that is not enough.
    RayCaster(const scene::Scene& scene, std::span<const glm::dmat4> world);
    RayCaster(scene::Scene&&, std::span<const glm::dmat4>) = delete;
    RayCaster(RayCaster&&) noexcept;
    RayCaster& operator=(RayCaster&&) noexcept;
    ~RayCaster();
    static constexpr uint64_t kBytesPerTriangle = 192;

    /// Whether a triangle lies strictly between two points, m; not those of the meshes at the nodes `without`
    /// (ascending). False if a point is not finite or beyond 10 kFarthest.
    bool blocked(glm::dvec3 from, glm::dvec3 to, std::span<const uint32_t> without = {}) const;
    /// The first triangle from `from` to `to`; of several at one place that of the least number in the scene.
    std::optional<Hit> nearest(glm::dvec3 from, glm::dvec3 to, std::span<const uint32_t> without = {}) const;

    /// Amid the triangles, m: corners are rounded by 1e-7 of their distance from it.
    glm::dvec3 middle() const { return list_.origin; }
    size_t triangles() const { return list_.triangles.size(); }
    /// Triangles without area, and those with a corner that is not finite or beyond kFarthest.
    uint64_t left_out() const { return list_.left_out; }
    /// Of memory that is in use.
    uint64_t bytes() const;

private:
    struct Sight;
    struct Crossing;
    struct Query;
    bool has_way(glm::dvec3 from, glm::dvec3 to) const;
    bool counts(const Crossing& crossing, std::span<const uint32_t> without) const;

    const scene::Scene* scene_ = nullptr;
    TriangleList list_;
    std::unique_ptr<const BoxHierarchy> boxes_;
};

}  // namespace vesper::rays
