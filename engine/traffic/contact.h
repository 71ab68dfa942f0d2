// Collisions of cars: boxes in plan, and blows. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include <glm/glm.hpp>

#include "traffic/vehicle.h"

namespace vesper::traffic {

/// Difference of height above which objects do not collide, as on and below a bridge, m.
constexpr double kLevels = 2.5;

/// Friction of a scraping car: force along over force across.
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

/// Overlap of a box with another.
struct Overlap {
    glm::dvec2 normal{0};  ///< unit, the shortest way out of the other
    double depth = 0;      ///< length of that way, m
    glm::dvec2 point{0};   ///< middle of the common area
};
/// The overlap by separating axes (Gottschalk, Lin and Manocha 1996); empty if there is none.
std::optional<Overlap> overlap(const GroundBox&, const GroundBox& other);

/// Opponent of a car in a collision, with its compliance along `heading` and across, 1/kg; 0: immovable.
struct Opponent {
    glm::dvec2 velocity{0}, heading{0, -1};
    double along = 0, across = 0;
    double give(glm::dvec2 direction) const;
};

/// An inelastic blow at `arm` (m from the centre of mass) along `normal`, with friction (kScrape). Returns the impulse
/// on the car, N s; 0 if the two separate already.
glm::dvec2 strike(VehicleState&, const VehicleParameters&, glm::dvec2 arm, glm::dvec2 normal, const Opponent& = {});

/// Velocity of the car at `arm`, m/s.
glm::dvec2 velocity_at(const VehicleState&, glm::dvec2 arm);

}  // namespace vesper::traffic
