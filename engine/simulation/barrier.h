// Kerbs, walls and rails that a car cannot pass. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "simulation/vehicle.h"

namespace vesper {

using Barrier = std::vector<glm::dvec2>;  ///< a line in plan, X and Z of the scene, m

/// Stops the corners of a car that crossed a barrier since `before`: an inelastic blow there, with friction (kScrape) along the barrier, and
/// the car put back to its side. Takes energy, never gives any. Tells whether there was a blow.
bool collide(VehicleState&, const VehicleState& before, const VehicleParameters&, const std::vector<Barrier>&);

}  // namespace vesper
