// Road layouts (CIE 140:2000, EN 13201-3:2015): carriageway, surface, luminaires, observers.
// SPDX-License-Identifier: MIT
// The frame of a layout: x along the road in the direction of view, y to the left from the right edge of the
// carriageway, z up from its surface, m. The first luminaire of a row on the right stands at x = 0.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "photometry/distribution.h"
#include "photometry/reflection_table.h"

namespace vesper::roads {

enum class Arrangement : uint8_t {
    Right,      ///< one row, at the right edge
    Left,       ///< one row, at the left edge
    Opposite,   ///< both rows, facing one another
    Staggered,  ///< both rows, the left one half a spacing further on
    Central,    ///< two rows back to back on the reservation beside the carriageway (to its left in right-hand traffic)
    List        ///< positions, repeated every spacing
};

/// One luminaire of a spacing.
struct LuminaireMount {
    glm::dvec3 position{0};  ///< of its photometric centre, m
    double facing = 90;      ///< where the street side (CIE: C90) points in plan, deg from x towards y
};

struct RoadLayout {
    std::string name;
    double width = 7;                ///< of the carriageway, m
    int lanes = 2;                   ///< of equal width
    bool left_hand_traffic = false;  ///< numbers the lanes from the left, puts a reservation on the right

    Arrangement arrangement = Arrangement::Right;
    double spacing = 30;     ///< S, between two luminaires of a row, m
    double height = 8;       ///< H, of the photometric centre above the road, m
    double overhang = 0;     ///< of the photometric centre over the carriageway from its edge, m; negative: behind it
    double reservation = 0;  ///< Central: distance between the two carriageways, m
    std::vector<LuminaireMount> list;  ///< Arrangement::List
    /// Applied in this order, deg: a turn about the vertical (counter-clockwise from above), a tilt about the C0-C180
    /// axis that raises the C90 side, a roll about the C90-C270 axis that raises the C180 side.
    double orientation = 0, tilt = 0, roll = 0;
    /// C0 of the file points to the street side (practice in IES files; C = C_CIE - 90) instead of along the road.
    bool c0_street_side = false;

    Distribution distribution;
    double flux_factor = 1;         ///< on the candela of the distribution
    double maintenance_factor = 1;  ///< MF, on luminance and illuminance, not on TI
    double colour_temperature = 0;  ///< K, for pictures; 0: white
    ReflectionTable surface;
    double age = 23;  ///< of the observer of TI, years
};

/// Throws Error (starting with the layout's name) if a value is out of range.
void check_layout(const RoadLayout&);

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
struct CalculationField {
    std::vector<double> x, y;
    double step = 0;  ///< D, m
};
CalculationField calculation_field(const RoadLayout&);
/// The greatest mounting height, m.
double mounting_height(const RoadLayout&);

/// Figures of the observer in the middle of a lane.
struct LaneObserver {
    int lane = 1;                        ///< from 1 at the nearside edge
    glm::dvec3 eye{0};                   ///< 60 m before the field, 1.5 m up
    double average_luminance = 0;        ///< over all points, cd/m^2
    double overall_uniformity = 0;       ///< least / average
    double longitudinal_uniformity = 0;  ///< least / greatest along the middle of the lane
    glm::dvec3 glare_eye{0};             ///< where along the lane TI is worst
    double veil = 0;                     ///< there, cd/m^2
    double threshold_increment = 0;      ///< there, %, with the initial average luminance
};

/// The observers in their places, lane by lane, without figures.
std::vector<LaneObserver> lane_observers(const RoadLayout&);

}  // namespace vesper::roads
