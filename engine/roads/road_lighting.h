// Figures of a road layout as CIE 140:2000 and EN 13201-3:2015 calculate them, in the frame of road_layout.h.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "roads/road_layout.h"

namespace vesper::roads {

/// Maintained horizontal illuminance, lx: luminaires within 5H (EN 13201-3, 7.2).
double horizontal_illuminance(const RoadLayout&, std::span<const PlacedLuminaire>, glm::dvec2 point);
/// The reduced luminance coefficient of a luminaire for a point and an observer, sr^-1. 0 outside the table, or if the
/// luminaire is not within 5H before, 12H beyond and 5H beside the point (CIE 140, 4.3).
double reflected_towards(const RoadLayout&, const PlacedLuminaire&, glm::dvec2 point, glm::dvec2 observer);
/// Maintained luminance towards an observer, cd/m^2, by all luminaires with a coefficient above 0.
double luminance_towards(const RoadLayout&, std::span<const PlacedLuminaire>, glm::dvec2 point, glm::dvec2 observer);
/// Veiling luminance of new luminaires for an eye that looks along x and 1 degree down, cd/m^2; not those beyond 500 m,
/// nor above the car's roof, 20 degrees up (EN 13201-3, 8.5).
double veiling_luminance(const RoadLayout&, std::span<const PlacedLuminaire>, glm::dvec3 eye);
/// Greatest distance along the road of luminaires that count as glare (CIE 140), m.
constexpr double kGlareRange = 500;

/// A point of the field that is calculated (EN 13201-3, 7.1).
struct FieldPoint {
    double x = 0, y = 0;            ///< m
    double illuminance = 0;         ///< E_h, lx
    std::vector<double> luminance;  ///< for each observer, cd/m^2
};

struct RoadLighting {
    CalculationField field;
    std::vector<FieldPoint> points;  ///< field.x.size() for each field.y
    std::vector<LaneObserver> observers;
    // The worst of the observers.
    double average_luminance = 0, overall_uniformity = 0, longitudinal_uniformity = 0, threshold_increment = 0;
    double average_illuminance = 0, minimum_illuminance = 0;  ///< lx
    /// E of the strip of a lane's width outside the right and left edge over that of the strip inside; the lesser.
    double edge_ratio_right = 0, edge_ratio_left = 0, edge_ratio = 0;
    bool wet = false;  ///< as the surface is
};

/// Calculates all figures. Throws Error if a value is out of range, or if no light reaches an observer.
RoadLighting calculate_lighting(const RoadLayout&);

/// A lighting class for motorised traffic (EN 13201-2:2015, Table 1): all but `increment` are lower limits, of the dry
/// road but for `overall_wet`.
struct LightingClass {
    const char* name;
    double luminance, overall, longitudinal, increment, edge, overall_wet = 0.15;
};
std::span<const LightingClass> lighting_classes();
/// The class of a name, or null.
const LightingClass* find_lighting_class(const std::string& name);
/// True if all limits hold; for a wet road if `overall_wet` holds.
bool fulfils(const RoadLighting&, const LightingClass&);
/// The most demanding class whose limits all hold; null without one, and for wet roads.
const LightingClass* reached_class(const RoadLighting&);

}  // namespace vesper::roads
