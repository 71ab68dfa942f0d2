// Cars that meet something: ground boxes in plan, and blows. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include <glm/glm.hpp>

#include "traffic/vehicle.h"

namespace vesper::traffic {

/// Things so far above one another do not meet, as on a bridge and below it, m.
constexpr double kLevels = 2.5;

/// What of a car that scrapes along something is lost: force along over force across.
constexpr double kScrape = 0.3;

/// A body seen from above, in the plane of VehicleState.
struct GroundBox {
    glm::dvec2 centre{0};  ///< X and Z, m
    double yaw = 0;
    double length = 4.4, width = 1.8;  ///< m

    glm::dvec2 forward() const;
    std::array<glm::dvec2, 4> corners() const;
    bool contains(glm::dvec2 point) const;
};
GroundBox ground_box(const VehicleState&, const VehicleParameters&);

/// How one lies in another.
struct Overlap {
    glm::dvec2 normal{0};  ///< unit, the shortest way out of the other, and
    double depth = 0;      ///< how far that is, m
    glm::dvec2 point{0};   ///< in the middle of what they share
};
/// Separating axes (Gottschalk, Lin and Manocha 1996): nothing where one lies between them.
std::optional<Overlap> overlap(const GroundBox&, const GroundBox& other);

/// What a car is struck against. It gives way along `heading` and across by so much, 1/kg; 0: not at all.
struct Opponent {
    glm::dvec2 velocity{0}, heading{0, -1};
    double along = 0, across = 0;
    double give(glm::dvec2 direction) const;
};

/// A blow at `arm` (m from the centre of mass) out along `normal`: what is hit and the car go on together there, with friction
/// (kScrape) between them. Gives the impulse on the car, N s; 0 where they part anyhow.
glm::dvec2 strike(VehicleState&, const VehicleParameters&, glm::dvec2 arm, glm::dvec2 normal, const Opponent& = {});

/// Of the car at `arm`, m/s.
glm::dvec2 velocity_at(const VehicleState&, glm::dvec2 arm);

}  // namespace vesper::traffic
