// Road lighting as CIE 140:2000 and EN 13201-3:2015 calculate it. SPDX-License-Identifier: MIT
// The road's frame: x along the road in the direction of view, y to the left from the right edge of the carriageway, z
// up from its surface, m. The first luminaire of a row on the right stands at x = 0.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "photometry/distribution.h"
#include "photometry/reflection_table.h"

namespace vesper {

enum class Arrangement : uint8_t {
    Right,      ///< one row, at the right edge
    Left,       ///< one row, at the left edge
    Opposite,   ///< both rows, facing one another
    Staggered,  ///< both rows, the left one half a spacing further on
    Central,    ///< two rows back to back on the reservation beside the carriageway (to its left in right-hand traffic)
    List        ///< positions, repeated every spacing
};

/// One luminaire of a spacing.
struct RoadMount {
    glm::dvec3 position{0};  ///< of its photometric centre, m
    double facing = 90;      ///< where the street side (CIE: C90) points in plan, deg from x towards y
};

struct RoadLayout {
    std::string name;
    double width = 7;                ///< of the carriageway, m
    int lanes = 2;                   ///< of equal width
    bool left_hand_traffic = false;  ///< numbers the lanes from the left, puts a reservation on the right

    Arrangement arrangement = Arrangement::Right;
    double spacing = 30;  ///< S, between two luminaires of a row, m
    double height = 8;    ///< H, of the photometric centre above the road, m
    double overhang =
        0;  ///< of the photometric centre over the carriageway from its edge, m; negative: behind the edge
    double reservation = 0;       ///< Central: distance between the two carriageways, m
    std::vector<RoadMount> list;  ///< Arrangement::List
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
void check_road(const RoadLayout&);

/// A luminaire in place.
struct RoadLuminaire {
    glm::dvec3 position{0};
    glm::dmat3 axes{1};  ///< columns: C0, C90 and up (against the nadir) of its distribution
};

/// The luminaires of one spacing (road_mounts), and all with x in [low, high] (road_luminaires).
std::vector<RoadMount> road_mounts(const RoadLayout&);
std::vector<RoadLuminaire> road_luminaires(const RoadLayout&, double low, double high);

/// The calculated part of the road: N values of x over one spacing (10 up to 30 m, then steps of 3 m or less),
/// three values of y in every lane (EN 13201-3, 7.1).
struct RoadField {
    std::vector<double> x, y;
    double step = 0;  ///< D, m
};
RoadField road_field(const RoadLayout&);
/// The greatest mounting height, m.
double road_height(const RoadLayout&);

/// Maintained horizontal illuminance, lx: luminaires within 5H (EN 13201-3, 7.2).
double horizontal_illuminance(const RoadLayout&, std::span<const RoadLuminaire>, glm::dvec2 point);
/// The reduced luminance coefficient of a luminaire for a point and an observer, sr^-1. 0 outside the table, or if the
/// luminaire is not within 5H before, 12H beyond and 5H beside the point (CIE 140, 4.3).
double reflected_towards(const RoadLayout&, const RoadLuminaire&, glm::dvec2 point, glm::dvec2 observer);
/// Maintained luminance towards an observer, cd/m^2, by all luminaires with a coefficient above 0.
double road_luminance(const RoadLayout&, std::span<const RoadLuminaire>, glm::dvec2 point, glm::dvec2 observer);
/// Veiling luminance for 1 lx at the eye, sr^-1, theta degrees off the line of sight: 1.5 to 60 degrees 9.86 (1 +
/// (age/66.4)^4) / theta^2, 0.1 to 1.5 degrees 10/theta^3 + 5/theta^2 (1 + (age/62.5)^4); otherwise 0 (EN 13201-3,
/// 8.5).
double road_glare(double theta, double age);
/// Veiling luminance of new luminaires for an eye that looks along x and 1 degree down, cd/m^2; not those beyond 500 m,
/// nor above the car's roof, 20 degrees up (EN 13201-3, 8.5).
double veiling_luminance(const RoadLayout&, std::span<const RoadLuminaire>, glm::dvec3 eye);
/// Greatest distance along the road of luminaires that count as glare (CIE 140), m.
constexpr double kGlareRange = 500;
/// TI, %: 65 Lv / Lav^0.8, above 5 cd/m^2 95 Lv / Lav^1.05 (CIE 140; EN 13201-3, 8.5).
double threshold_increment(double veil, double average_luminance);

/// A point of the field that is calculated (EN 13201-3, 7.1).
struct FieldPoint {
    double x = 0, y = 0;            ///< m
    double illuminance = 0;         ///< E_h, lx
    std::vector<double> luminance;  ///< for each observer, cd/m^2
};

/// Figures of the observer in the middle of a lane.
struct RoadObserver {
    int lane = 1;                      ///< from 1 at the nearside edge
    glm::dvec3 eye{0};                 ///< 60 m before the field, 1.5 m up
    double average_luminance = 0;      ///< over all points, cd/m^2
    double overall_uniformity = 0;     ///< least / average
    double lengthwise_uniformity = 0;  ///< least / greatest along the middle of the lane
    glm::dvec3 glare_eye{0};           ///< where along the lane TI is worst
    double veil = 0;                   ///< there, cd/m^2
    double threshold_increment = 0;    ///< there, %, with the initial average luminance
};

/// The observers in their places, lane by lane, without figures.
std::vector<RoadObserver> road_observers(const RoadLayout&);

struct RoadResult {
    RoadField field;
    std::vector<FieldPoint> points;  ///< field.x.size() for each field.y
    std::vector<RoadObserver> observers;
    // The worst of the observers.
    double average_luminance = 0, overall_uniformity = 0, lengthwise_uniformity = 0, threshold_increment = 0;
    double average_illuminance = 0, minimum_illuminance = 0;  ///< lx
    /// E of the strip of a lane's width outside the right and left edge over that of the strip inside; the lesser.
    double edge_ratio_right = 0, edge_ratio_left = 0, edge_ratio = 0;
    bool wet = false;  ///< as the surface is
};

/// Calculates all figures. Throws Error if a value is out of range, or if no light reaches an observer.
RoadResult calculate_road(const RoadLayout&);

/// A lighting class for motorised traffic (EN 13201-2:2015, Table 1): all but `increment` are lower limits, of the dry
/// road but for `overall_wet`.
struct LightingClass {
    const char* name;
    double luminance, overall, lengthwise, increment, edge, overall_wet = 0.15;
};
std::span<const LightingClass> lighting_classes();
/// The class of a name, or null.
const LightingClass* find_lighting_class(const std::string& name);
/// True if all limits hold; for a wet road if `overall_wet` holds.
bool fulfils(const RoadResult&, const LightingClass&);
/// The most demanding class whose limits all hold; null without one, and for wet roads.
const LightingClass* reached_class(const RoadResult&);

}  // namespace vesper
