// What `vesper road --stv` says of small targets. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "roads/small_targets.h"

namespace vesper::commands {

/// Small targets of a road, and without its occluders if it has any.
struct RoadTargets {
    roads::SmallTargetVisibility counted;
    std::optional<roads::SmallTargetVisibility> standard;
};

/// Calculates them. Throws Error.
RoadTargets road_targets(const roads::LoadedLayout&, double reflectance);
/// STV and the range of visibility levels, for a terminal.
std::string text_of(const RoadTargets&);
/// Visibility levels as a table: x across, y down, the left edge on top.
std::string grid_text_of(const roads::CalculationField&, const RoadTargets&);
/// All figures, and those of each target.
nlohmann::ordered_json json_of(const RoadTargets&);
/// Draws the road from above: about every target a cell with its visibility level. Throws Error.
void write_target_map(const std::string& file, const roads::LoadedLayout&, const roads::CalculationField&,
                      const roads::SmallTargetVisibility&);

}  // namespace vesper::commands
