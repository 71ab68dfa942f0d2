// Illuminance of a scene's lamps, on the host. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "rays/ray_caster.h"
#include "scene/lamp.h"
#include "transport/lanes.h"
#include "transport/patch.h"
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
    /// An estimate of the same in the mean over places beside each other, by `shadow_rays` at most of each,
    /// without a threshold: right on average, and of any number of lamps in about the same time (resampled importance:
    /// Talbot, Cline and Egbert 2005).
    void sample(std::span<const SurfacePlace> places, uint32_t shadow_rays, Random& random,
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
        glm::dvec3 place;        // of directional lamps the way to it, m
        glm::dvec3 back;         // where its axis does not point, unit length
        glm::dvec2 ramp;         // scene::cone_ramp()
        double largest;          // intensity, cd
        bool directional, cone;  // cone: its intensity is that of the ramp
    };
    // Four lamps; directional ones have no intensity here.
    struct BoundLanes {
        Lanes3 place, back;  // place: from the middle of the rays, m
        Lanes slope{}, offset{}, largest{};
    };
    // About how much each lamp gives some places at most, lx.
    struct Most {
        std::vector<float> lux;    // of each
        std::vector<double> ends;  // sums up to and with each kLanes of them
    };
    struct Candidate {
        size_t lamp;
        double weight;
    };

    struct Way;
    static Way way_to(const Bound& lamp, glm::dvec3 point, glm::dvec3 normal);
    double unshadowed(size_t lamp, const Way& way) const;
    bool blocked(size_t lamp, const Way& way, glm::dvec3 point, glm::dvec3 normal) const;
    bool lights(size_t lamp, uint32_t node, const Way& way) const;
    Most most_at(std::span<const SurfacePlace> places) const;
    std::vector<Candidate> choose(const Most& most, uint32_t steps, Random& random) const;

    const scene::Scene& scene_;
    const rays::RayCaster& rays_;
    std::vector<Placed> lamps_;
    std::vector<Bound> bounds_;  // of each
    std::vector<BoundLanes> bound_lanes_;
    std::vector<size_t> directional_;  // lamps
    std::vector<bool> in_fixture_;     // nodes: of any lamp
};

}  // namespace vesper::transport
