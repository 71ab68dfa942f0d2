// Road layouts (vesper/road_lighting.hpp) with the photometry that they name; luminaires and observers in place.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include <vesper/road_lighting.hpp>

#include "photometry/distribution.h"
#include "photometry/reflection_table.h"

namespace vesper::roads {

inline glm::dvec3 vector_of(const LayoutPoint& p) { return {p.x, p.y, p.z}; }
inline LayoutPoint point_of(glm::dvec3 v) { return {v.x, v.y, v.z}; }

class Occluders;

/// A layout with the contents of its files.
struct LoadedLayout : RoadLayout {
    photometry::Distribution distribution;    ///< of `luminaire`
    photometry::ReflectionTable surface;      ///< `reflection_table`, scaled to `q0`
    double colour_temperature = 0;            ///< of the luminaires, for pictures, K; 0: white
    std::shared_ptr<const Occluders> hiding;  ///< `occluders`; null: nothing hides luminaires, as in the standard
};

/// Throw Error (starting with the layout's name) if a value is out of range.
void check_layout(const RoadLayout&);
void check_layout(const LoadedLayout&);

/// A luminaire in place.
struct PlacedLuminaire {
    glm::dvec3 position{0};
    glm::dmat3 axes{1};  ///< columns: C0, C90 and up (against the nadir) of its distribution
};

/// The luminaires of one spacing (luminaire_mounts), and all with x in [low, high] (placed_luminaires).
std::vector<LuminaireMount> luminaire_mounts(const RoadLayout&);
std::vector<PlacedLuminaire> placed_luminaires(const RoadLayout&, double low, double high);

/// The calculated part of the road: N values of x over one spacing (10 up to 30 m, then steps of 3 m or less),
/// three values of y in every lane (EN 13201-3, 7.1).
CalculationField calculation_field(const RoadLayout&);
/// The greatest mounting height, m.
double mounting_height(const RoadLayout&);
/// The observers in their places, lane by lane, without figures.
std::vector<LaneObserver> lane_observers(const RoadLayout&);

}  // namespace vesper::roads
