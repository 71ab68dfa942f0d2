// The first reflection of lamps that move, as a few patches of light. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "rays/ray_caster.h"
#include "transport/surfaces.h"

namespace vesper::transport {

/// Where surfaces at rest reflect a part of a lamp's light: a matt light (instant radiosity: Keller 1997).
struct LitPatch {
    glm::dvec3 position{0};   ///< m, world; the mean by the light that is reflected
    glm::dvec3 normal{0};     ///< likewise, unit length
    double radius = 0;        ///< of a disc as spread out as that light, m
    glm::dvec3 intensity{0};  ///< along the normal, RGB cd: it falls with the cosine
};

/// Rays in directions of equal flux from each of the nearest lamps that move, in kParts parts. Those of a part that
/// meet surfaces that face the same side make a patch. The rays go with the lamp, so that patches move as steadily as
/// it does.
///
/// An estimate: nothing hides what a patch sends, bodies that move get light of it and reflect none, and near a patch
/// the light is that of a disc, not of its true outline.
class LampReflections {
public:
    /// The scene with its nodes at `world`, of which those that are `moving` neither hide nor reflect. Keeps a
    /// reference to the scene. Throws Error if there is no memory for its triangles.
    LampReflections(const scene::Scene& scene, std::span<const glm::dmat4> world, const std::vector<bool>& moving);
    LampReflections(scene::Scene&&, std::span<const glm::dmat4>, const std::vector<bool>&) = delete;
    LampReflections(const LampReflections&) = delete;
    LampReflections& operator=(const LampReflections&) = delete;

    /// With all nodes at `world` and these factors on their light (empty: 1), of the kMostLamps lamps nearest to `eye`
    /// (m). Equal lamps below one node, such as two headlamps, share patches.
    std::vector<LitPatch> patches(std::span<const glm::dmat4> world, std::span<const float> factors,
                                  glm::dvec3 eye) const;
    static constexpr uint32_t kAbove = 3, kBeside = 2, kParts = kAbove * kBeside, kRaysOfPart = 24, kMostLamps = 8;
    static constexpr double kFarthest = 100, kLeastFlux = 50;  ///< m from the eye; lm: others reflect nothing

private:
    struct Fan {                             // of a lamp, in its own frame
        double flux = 0;                     // lm
        std::vector<glm::dvec3> directions;  // kRaysOfPart of each part
    };
    struct MovingLamp {
        uint32_t node, lamp;
    };

    const scene::Scene& scene_;
    std::vector<glm::dmat4> at_rest_;
    rays::RayCaster rays_;
    Surfaces surfaces_;
    std::vector<Fan> fans_;  // of each lamp of the scene; of those that move
    std::vector<MovingLamp> lamps_;
};

}  // namespace vesper::transport
