// Kerbs, walls and rails that a car cannot pass. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "traffic/vehicle.h"

namespace vesper::traffic {

struct Barrier {
    std::vector<glm::dvec2> line;  ///< in plan, X and Z of the scene, m
    std::optional<double> height;  ///< Y of its foot, m; empty: at every height
};

/// Stops the corners of a car that crossed a barrier since `before`: an inelastic blow there, with friction (kScrape)
/// along the barrier, and the car put back to its side. Never adds energy. Returns true if there was a blow. `height`:
/// Y of the road under the car, m; barriers more than kLevels away belong to another road.
bool collide(VehicleState&, const VehicleState& before, const VehicleParameters&, const std::vector<Barrier>&,
             double height = 0);

}  // namespace vesper::traffic
