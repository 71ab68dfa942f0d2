// Figures of a road layout as CIE 140:2000 and EN 13201-3:2015 calculate them, in the frame of road_layout.h.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roads/road_layout.h"

namespace vesper::roads {

/// Maintained horizontal illuminance, lx: luminaires within 5H (EN 13201-3, 7.2).
double horizontal_illuminance(const LoadedLayout&, std::span<const PlacedLuminaire>, glm::dvec2 point);
/// Maintained illuminance, lx, of an upright plane at a point that faces the eyes that look along x: luminaires within
/// 12H before the point and 5H beside it. H here is their height above the point.
double facing_illuminance(const LoadedLayout&, std::span<const PlacedLuminaire>, glm::dvec3 point);
/// The reduced luminance coefficient of a luminaire for a point and an observer, sr^-1. 0 outside the table, or if the
/// luminaire is not within 5H before, 12H beyond and 5H beside the point (CIE 140, 4.3).
double reflected_towards(const LoadedLayout&, const PlacedLuminaire&, glm::dvec2 point, glm::dvec2 observer);
/// Maintained luminance towards an observer, cd/m^2, by all luminaires with a coefficient above 0.
double luminance_towards(const LoadedLayout&, std::span<const PlacedLuminaire>, glm::dvec2 point, glm::dvec2 observer);
/// Veiling luminance of new luminaires for an eye that looks along x and 1 degree down, cd/m^2; not those beyond 500 m,
/// nor above the car's roof, 20 degrees up (EN 13201-3, 8.5).
double veiling_luminance(const LoadedLayout&, std::span<const PlacedLuminaire>, glm::dvec3 eye);
/// The luminaires that a place sees; all of them without occluders, in their order.
std::vector<PlacedLuminaire> seen_from(const LoadedLayout&, std::span<const PlacedLuminaire>, glm::dvec3 place);
/// Greatest distance along the road of luminaires that count as glare (CIE 140), m.
constexpr double kGlareRange = 500;

/// Calculates all figures; luminaires that occluders hide from a point do not light it, nor dazzle an eye that does not
/// see them. Throws Error if a value is out of range, or if no light reaches an observer.
RoadLighting calculate_lighting(const LoadedLayout&);

}  // namespace vesper::roads
