// Reading OpenDRIVE files, 1.4 to 1.8. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "base/limits.h"
#include "roads/road_network.h"

namespace vesper::roads {

/// Limits of a file. Those that cost memory scale with VESPER_LIMITS (base/limits.h).
struct RoadLimits {
    uint64_t file_bytes = scaled_limit(256ull << 20);
    size_t roads = scaled_limit(200'000);
    size_t elements = scaled_limit(8'000'000);  ///< geometries, lanes, widths, marks, objects and signals together
    double road_length = 1e6;                   ///< m, of one
    double total_length = static_cast<double>(scaled_limit(5'000'000));  ///< m, of all
    double lane_width = 1000;                                            ///< m, of one lane, and of all of one side
    double height = 1e5;                                                 ///< m, above or below 0
    double turns = 1e4;                                                  ///< rad, that one geometry may turn
    double spiral_turns = 100;  ///< rad, that a spiral may turn: each of its points takes work for each rad
};

/// Reads a road network. Throws Error naming file, line and reason if there is no usable geometry. A violated rule
/// without harm is noted, and the file is read as meant.
RoadNetwork read_opendrive(const std::filesystem::path& file, const RoadLimits& limits = {});
/// As read_opendrive(), from memory; `name` is for messages.
RoadNetwork parse_opendrive(std::string_view text, const std::string& name, const RoadLimits& limits = {});

}  // namespace vesper::roads
