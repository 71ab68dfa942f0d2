// Road layouts from JSON (docs/road.md), and their files. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "roads/road_layout.h"

namespace vesper::roads {

/// What takes the place of what the file says. Names of files are as the caller sees them.
struct LayoutOverrides {
    std::string luminaire;         ///< a photometric file
    std::string occluders;         ///< a scene
    bool occlusion = true;         ///< false: occluders are not read and hide nothing
    std::string reflection_table;  ///< a built-in name or a file; its own Q0 counts unless one is given here
    std::optional<double> q0, spacing, height, overhang, tilt, maintenance_factor;
};

/// Reads and checks a layout with its luminaire and reflection table, both relative to the file's folder. Throws Error
/// naming file, JSON pointer and reason.
LoadedLayout read_layout(const std::filesystem::path& file, const LayoutOverrides& overrides = {});

/// Checks a layout and reads its luminaire and reflection table. Throws Error.
LoadedLayout load_layout(const RoadLayout&);

}  // namespace vesper::roads
