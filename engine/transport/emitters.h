// Emitting triangles as lights: which of them to look at from a point. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "transport/surfaces.h"

namespace vesper::transport {

/// The triangles of a scene that emit, as Surfaces has them.
class Emitters {
public:
    struct Emitter {
        uint32_t node, primitive, triangle;  ///< as in rays::Hit
        std::array<glm::dvec3, 3> corners;   ///< m, world
        glm::dvec3 outwards;                 ///< unit length, where its front faces
        double area;                         ///< m^2
        double luminance;                    ///< cd/m^2, of its material without texture, of a picture the mean
        bool double_sided;
    };

    /// Keeps nothing of the scene. Throws Error if more than kMost triangles emit.
    static constexpr size_t kMost = size_t{1} << 22;
    Emitters(const scene::Scene& scene, std::span<const glm::dmat4> world, const Surfaces& surfaces);

    std::span<const Emitter> list() const { return list_; }  ///< ascending by node, primitive and triangle
    /// Of the triangle that a ray meets; none if it emits nothing.
    std::optional<size_t> find(const rays::Hit& hit) const;

private:
    std::vector<Emitter> list_;
};

/// How often each emitter is looked at from a point: in proportion to about the illuminance that it gives if it is
/// seen.
class EmitterChoice {
public:
    EmitterChoice(std::span<const Emitters::Emitter> emitters, glm::dvec3 point, glm::dvec3 normal);
    /// For points anywhere: in proportion to the light that each emits.
    explicit EmitterChoice(std::span<const Emitters::Emitter> emitters);

    bool any() const { return !ends_.empty() && ends_.back() > 0; }
    /// `share` from 0 to 1, which is used up: what is left of it is from 0 to 1 again.
    size_t choose(double& share) const;
    double probability(size_t emitter) const;

private:
    std::vector<double> ends_;  // sums up to and with each emitter
};

}  // namespace vesper::transport
