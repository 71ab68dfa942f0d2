// Where the light of a scene goes. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "transport/radiosity.h"

namespace vesper::transport {

/// Luminous flux, lm. Light is conserved if what is emitted is `absorbed` and what the sky gets.
struct FluxBalance {
    double lamps = 0, emitters = 0;  ///< emitted; lamps without directional ones
    double sky_directly = 0;         ///< of that, what meets no surface
    double sky_reflected = 0;        ///< what surfaces send to the sky
    double absorbed = 0;             ///< by surfaces

    double emitted() const { return lamps + emitters; }
    double found() const { return absorbed + sky_directly + sky_reflected; }
};

/// Of a scene at rest without its sky, as gather_radiosity() was given it, and with `reflections` of light. What leaves
/// directly is found by rays from the sources, 1,024 of each lamp and 262,144 of all emitters, all else from the cells.
FluxBalance flux_balance(const scene::Scene& scene, std::span<const glm::dmat4> world, const std::vector<bool>& moving,
                         const Radiosity& radiosity, uint32_t reflections);

}  // namespace vesper::transport
