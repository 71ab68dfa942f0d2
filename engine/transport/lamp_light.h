// Illuminance of a scene's lamps, on the host. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "rays/ray_caster.h"
#include "transport/sampling.h"

namespace vesper::transport {

/// What the lamps of a scene give a point that sees them: E = I cos / d^2 of each (directional ones: E cos), lamps as
/// points. A lamp's own fixture (scene/fixtures.h) does not hide it.
class LampLight {
public:
    /// The scene with its nodes at `world`. Keeps references to the first and the last.
    LampLight(const scene::Scene& scene, std::span<const glm::dmat4> world, const rays::RayCaster& rays);
    LampLight(scene::Scene&&, std::span<const glm::dmat4>, const rays::RayCaster&) = delete;

    /// On a surface with the unit normal `normal`, lx RGB. Lamps that give less than `threshold` lx count as dark.
    /// `node`: that has the surface; lamps of whose housing it is give it nothing, since their intensities hold its
    /// light.
    glm::dvec3 illuminance(glm::dvec3 point, glm::dvec3 normal, double threshold, uint32_t node = scene::kNone) const;

    /// What one lamp gives.
    struct Share {
        uint32_t node;  ///< that has the lamp
        glm::dvec3 lux;
    };
    /// An estimate of the same by `rays` shadow rays at most, without a threshold: right on average, and of any number
    /// of lamps in about the same time (resampled importance: Talbot, Cline and Egbert 2005).
    void sample(glm::dvec3 point, glm::dvec3 normal, uint32_t node, uint32_t rays, Random& random,
                std::vector<Share>& shares) const;

private:
    struct Placed {
        uint32_t node;
        const scene::Lamp* lamp;
        glm::dmat3 to_lamp;             // directions
        std::vector<uint32_t> fixture;  // nodes
        double housing;                 // how far around it those are that, m
    };
    // What all lamps are asked for at each point, apart from the rest.
    struct Bound {
        glm::dvec3 place;  // of directional lamps the way to it, m
        double largest;    // intensity, cd
        bool directional;
    };

    struct Way;
    static Way way_to(const Bound& lamp, glm::dvec3 point, glm::dvec3 normal);
    double unshadowed(size_t lamp, const Way& way) const;
    bool blocked(size_t lamp, const Way& way, glm::dvec3 point, glm::dvec3 normal) const;
    bool lights(size_t lamp, uint32_t node, const Way& way) const;

    const scene::Scene& scene_;
    const rays::RayCaster& rays_;
    std::vector<Placed> lamps_;
    std::vector<Bound> bounds_;     // of each
    std::vector<bool> in_fixture_;  // nodes: of any lamp
};

}  // namespace vesper::transport
