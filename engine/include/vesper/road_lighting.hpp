/** @file
 * Road lighting by EN 13201-3:2015 (CIE 140:2000), for C++17: a part of the library vesper::roads (docs/road.md).
 *
 * There is no global state; threads may call at the same time. Units: m, 1/sr, lx, cd/m^2; others are in the names.
 * Points are in the frame of a layout: x along the road in the direction of view, y to the left from the right edge of
 * the carriageway, z up from its surface. The first luminaire of a row on the right stands at x = 0.
 *
 * SPDX-License-Identifier: MIT
 */
#ifndef VESPER_ROAD_LIGHTING_HPP
#define VESPER_ROAD_LIGHTING_HPP

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <vesper/vesper.hpp>

/** OpenDRIVE roads as lit scenes, and road lighting. */
namespace vesper::roads {

/** A point in the frame of a layout. */
struct LayoutPoint {
    double x = 0; /**< along the road */
    double y = 0; /**< to the left */
    double z = 0; /**< up */
};

/** Arrangement of the luminaires along a carriageway. */
enum class Arrangement {
    Right,     /**< one row, at the right edge */
    Left,      /**< one row, at the left edge */
    Opposite,  /**< both rows, facing one another */
    Staggered, /**< both rows, the left one half a spacing further on */
    Central,   /**< two rows back to back on the reservation */
    List       /**< RoadLayout::mounts, repeated every spacing */
};

/** A luminaire of Arrangement::List. */
struct LuminaireMount {
    LayoutPoint position;   /**< of its photometric centre */
    double facing_deg = 90; /**< direction of its street side (C90 of CIE) in plan, from x towards y */
};

/** Carriageway, surface and luminaires of a calculation. */
struct RoadLayout {
    std::string name = {};          /**< begins messages */
    double width = 7;               /**< of the carriageway, 1 to 100 m */
    int lanes = 2;                  /**< of equal width, 1 to 12 */
    bool left_hand_traffic = false; /**< lanes are numbered from the left, and a reservation is on the right */

    Arrangement arrangement = Arrangement::Right; /**< of the luminaires */
    double spacing = 30;                          /**< S, from luminaire to luminaire of a row, 5 to 500 m */
    double height = 8;                            /**< H, of the photometric centres, 2 to 40 m */
    double overhang = 0;    /**< of the photometric centres over the carriageway from its edge, -50 to 50 m */
    double reservation = 0; /**< Central: between the two carriageways, 0 to 100 m */
    std::vector<LuminaireMount> mounts = {}; /**< List: 1 to 32 luminaires */
    double orientation_deg = 0;              /**< first a turn about the vertical, counter-clockwise from above */
    double tilt_deg = 0;                     /**< then one about the C0-C180 axis that raises the C90 side */
    double roll_deg = 0;                     /**< then one about the C90-C270 axis that raises the C180 side */

    std::filesystem::path luminaire = {}; /**< photometric file: IES, EULUMDAT or a laboratory's grid */
    /** C0 of the file points to the street side (practice in IES files: C = C_CIE - 90) instead of along the road. */
    bool c0_street_side = false;
    double flux_factor = 1;        /**< on all intensities, 0 to 1000 */
    double maintenance_factor = 1; /**< MF, on luminance and illuminance, not on TI, 0.01 to 1 */

    std::string reflection_table = "R3"; /**< R1 to R4, C1, C2 (dry), W3, W4 (wet), or a CSV file */
    double q0 = 0;                       /**< to which the table is scaled, 0.001 to 10 1/sr; 0: that of the table */

    double observer_age = 23;      /**< for TI, 1 to 120 years */
    std::string wanted_class = {}; /**< M1 to M6 if a layout file names one; nothing depends on it */

    /** A glTF scene whose surfaces hide luminaires (trees, buildings), with the road at Y = 0, x along -Z and y along
     * -X. Empty: none; EN 13201-3 knows none. */
    std::filesystem::path occluders = {};
};

/** The calculated points: all pairs of x and y. */
struct CalculationField {
    std::vector<double> x; /**< over one spacing */
    std::vector<double> y; /**< three in each lane */
    double step = 0;       /**< D, between values of x */
};

/** A calculated point. Values are maintained. */
struct FieldPoint {
    double x = 0;                  /**< along the road */
    double y = 0;                  /**< to the left */
    double illuminance = 0;        /**< horizontal, lx */
    std::vector<double> luminance; /**< for each observer, cd/m^2 */
};

/** Figures of the observer in the middle of a lane. */
struct LaneObserver {
    int lane = 1;                           /**< from 1 at the nearside edge */
    LayoutPoint eye;                        /**< 60 m before the field, 1.5 m up */
    double average_luminance = 0;           /**< Lav, cd/m^2 */
    double overall_uniformity = 0;          /**< Uo: least / average */
    double longitudinal_uniformity = 0;     /**< Ul: least / greatest along the middle of the lane */
    LayoutPoint glare_eye;                  /**< where along the lane TI is worst */
    double veil = 0;                        /**< there, cd/m^2 */
    double threshold_increment_percent = 0; /**< TI, there, of the new installation */
};

/** Figures of a layout: the worst of all observers. */
struct RoadLighting {
    CalculationField field;                 /**< the calculated points */
    std::vector<FieldPoint> points;         /**< field.x.size() for each field.y */
    std::vector<LaneObserver> observers;    /**< lane by lane */
    double average_luminance = 0;           /**< Lav, cd/m^2 */
    double overall_uniformity = 0;          /**< Uo */
    double longitudinal_uniformity = 0;     /**< Ul */
    double threshold_increment_percent = 0; /**< TI */
    double average_illuminance = 0;         /**< lx */
    double minimum_illuminance = 0;         /**< lx */
    double edge_ratio_right = 0;            /**< E on a lane's width outside the right edge over that inside it */
    double edge_ratio_left = 0;             /**< likewise of the left edge */
    double edge_ratio = 0;                  /**< EIR, the lesser of both */
    bool wet = false;                       /**< as the reflection table is */
    std::size_t pairs = 0;                  /**< with occluders: points and luminaires in reach of one another */
    std::size_t hidden_pairs = 0;           /**< pairs of which the point does not see the luminaire */
};

/** A target of small-target visibility, on a point of the calculation field. Values are maintained. */
struct SmallTarget {
    double x = 0;                    /**< along the road */
    double y = 0;                    /**< to the left */
    double vertical_illuminance = 0; /**< at its centre, from the side of its observer, lx */
    double luminance = 0;            /**< Lt, cd/m^2 */
    double background = 0;           /**< Lb: of the road at its foot and above its top, cd/m^2 */
    double veil = 0;                 /**< Lv, in the eye of its observer, cd/m^2 */
    /** VL: negative where the target is darker. None where Lb + Lv is not from 1e-4 to 1e4 cd/m^2. */
    std::optional<double> visibility_level = {};
};

/** Visibility of small targets on a road (IES RP-8-00; docs/small-targets.md). */
struct SmallTargetVisibility {
    double reflectance = 0.5;         /**< of the targets, diffuse */
    std::vector<SmallTarget> targets; /**< in the order of RoadLighting::points */
    std::optional<double> stv = {};   /**< small-target visibility: weighted average of |VL|, where there is any */
};

/** A lighting class for motorised traffic (EN 13201-2:2015, Table 1). */
struct LightingClass {
    const char* name;                   /**< M1 to M6 */
    double average_luminance;           /**< least Lav of the dry road, cd/m^2 */
    double overall_uniformity;          /**< least Uo of the dry road */
    double longitudinal_uniformity;     /**< least Ul of the dry road */
    double threshold_increment_percent; /**< greatest TI of the dry road */
    double edge_ratio;                  /**< least EIR of the dry road */
    double wet_uniformity = 0.15;       /**< least Uo of the wet road */
};

/** Reads a layout file (docs/road.md) and the files that it names. Throws vesper::cpp::Failure: VESPER_FAILED if a file
 * cannot be used, VESPER_OUT_OF_MEMORY. */
RoadLayout read_road_layout(const std::filesystem::path& file);
/** Reads the files that a layout names and calculates its figures. Throws vesper::cpp::Failure: VESPER_BAD_ARGUMENT if
 * a value is out of range; VESPER_FAILED if a file cannot be used, or if no light is seen; VESPER_OUT_OF_MEMORY. */
RoadLighting calculate_road_lighting(const RoadLayout& layout);
/** Likewise the visibility of targets of a reflectance from 0.01 to 1 on the points of the calculation field. */
SmallTargetVisibility calculate_small_targets(const RoadLayout& layout, double reflectance = 0.5);

/** The classes, the most demanding first. */
const std::array<LightingClass, 6>& lighting_classes();
/** The class of a name, or null. */
const LightingClass* find_lighting_class(const std::string& name);
/** True if all limits hold: those of the dry road, or that of the wet one. */
bool fulfils(const RoadLighting& lighting, const LightingClass& wanted);
/** The most demanding class whose limits all hold; null without one, and for wet roads. */
const LightingClass* reached_class(const RoadLighting& lighting);

}  // namespace vesper::roads

#endif
