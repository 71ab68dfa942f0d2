// Surfaces that rays meet: what they reflect and emit. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "rays/ray_caster.h"

namespace vesper::scene {
struct Primitive;
}

namespace vesper::transport {

/// A point of a surface, seen from where a ray comes from.
struct SurfacePoint {
    glm::dvec3 position{0};     ///< m, world
    glm::dvec3 normal{0};       ///< of the triangle, unit length, towards the start of the ray
    glm::dvec3 reflectance{0};  ///< RGB, [0, 1]: base colour; light transport takes gloss for matt
    glm::dvec3 emission{0};     ///< RGB luminance, cd/m^2; 0 behind surfaces that are not double-sided
};

/// The materials of a scene at the places where rays meet its triangles. Textures count as in pictures at close view.
class Surfaces {
public:
    /// The scene with its nodes at `world`. Keeps references to both.
    Surfaces(const scene::Scene& scene, std::span<const glm::dmat4> world);
    Surfaces(scene::Scene&&, std::span<const glm::dmat4>) = delete;

    /// `hit`: of a ray from `from`. Meshes of a lamp's housing (scene/fixtures.h) emit nothing: its intensities
    /// have their light.
    SurfacePoint at(const rays::Hit& hit, glm::dvec3 from) const;
    /// The same but for its reflectance, which is 0.
    SurfacePoint emitted(const rays::Hit& hit, glm::dvec3 from) const;
    /// SurfacePoint::emission only.
    glm::dvec3 emission(const rays::Hit& hit, glm::dvec3 from) const;
    /// SurfacePoint::reflectance only, which is the same from everywhere.
    glm::dvec3 reflectance(const rays::Hit& hit) const;
    /// Whether the surface has no hole there (rays/opacity.h).
    bool stops_light(const rays::Hit& hit) const;
    /// Whether a ray from `from` hits the back of a triangle, by the order of its corners; of one that is double-sided,
    /// too. Those of materials with holes, such as railings and leaves, are sheets without a back.
    bool shows_back(const rays::Hit& hit, glm::dvec3 from) const;
    bool is_double_sided(const rays::Hit& hit) const;
    /// Whether a triangle of a node, in the world, is housing of a lamp.
    bool is_housing(uint32_t node, const std::array<glm::dvec3, 3>& corners) const;

private:
    struct Facet;
    const scene::Primitive& primitive_of(const rays::Hit& hit) const;
    Facet facet(const rays::Hit& hit, glm::dvec3 from) const;
    glm::dvec3 emission(const Facet& facet) const;
    glm::dvec3 reflectance(const Facet& facet) const;

    const scene::Scene& scene_;
    std::span<const glm::dmat4> world_;
    std::array<double, 256> codes_, emitted_;  // linear values of base colours, and of textures of emission
    std::vector<bool> holes_;                  // whether each material has some
    struct Housing {
        glm::dvec3 lamp;
        double reach;  // m
    };
    std::vector<std::vector<Housing>> housings_;  // of lamps whose fixture each node is
};

}  // namespace vesper::transport
