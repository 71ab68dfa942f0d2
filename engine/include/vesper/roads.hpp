/** @file
 * OpenDRIVE roads as lit scenes, for C++17; and all of the library vesper::roads (docs/embedding.md).
 * SPDX-License-Identifier: MIT
 */
#ifndef VESPER_ROADS_HPP
#define VESPER_ROADS_HPP

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <vesper/road_lighting.hpp>

namespace vesper::roads {

/** Side of a road on which street lamps stand. */
enum class LampSide {
    Auto,       /**< the outer side of traffic; both sides where the road is wider than 12 m */
    Right,      /**< right in the direction of the reference line */
    Left,       /**< left in that direction */
    Both,       /**< both sides, each with this spacing */
    Alternating /**< both sides in turns */
};

/** Rows of street lamps along roads. */
struct StreetLampOptions {
    /** From lamp to lamp, 2 to 1000 m, beside the street lamps of the file; 0: no rows. Empty: 30 m, and no rows if the
     * file has street lamps. */
    std::optional<double> spacing = {};
    double height = 0;              /**< of the light points, 2 to 60 m; 0: 8 m, on wide roads up to 12 m */
    LampSide side = LampSide::Auto; /**< of the road */
    double overhang = 1.2;          /**< from the pole towards the road, 0.1 to 20 m */
};

/** Lens that traffic lights show. */
enum class SignalState {
    Plan,  /**< by the controllers of the file, and a plan of phases in which no two crossing ways are green */
    Red,   /**< all red */
    Amber, /**< all amber, those for people on foot red */
    Green, /**< all green */
    Off    /**< all dark */
};

/** Options of convert_opendrive: those of `vesper convert ROADS.xodr`. */
struct ConvertOptions {
    StreetLampOptions lamps = {}; /**< rows of street lamps */
    /** File of the street lamps, IES or EULUMDAT, used unscaled. Empty: a built-in luminaire, scaled with the square of
     * its height above 8 m. */
    std::filesystem::path luminaire = {};
    SignalState signals = SignalState::Plan; /**< of all traffic lights */
    double signal_time = 0;                  /**< s of the plan, 0 to 1e6, that is shown */
};

/** Report of a conversion, in lines of English. */
struct RoadConversion {
    std::vector<std::string> parts; /**< parts of the scene */
    std::vector<std::string> notes; /**< defects of the file, each with its line and its treatment */
};

/** Converts an OpenDRIVE file (docs/roads.md) to a scene, .gltf or .glb, for vesper_scene_read. Throws
 * vesper::cpp::Failure as calculate_road_lighting. */
RoadConversion convert_opendrive(const std::filesystem::path& opendrive, const std::filesystem::path& scene,
                                 const ConvertOptions& options = {});

}  // namespace vesper::roads

#endif
