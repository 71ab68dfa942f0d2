// An OpenDRIVE file to a scene file. SPDX-License-Identifier: MIT
#pragma once

#include <vesper/roads.hpp>

#include "base/lower.h"

namespace vesper::roads {

/// Whether the name of a file ends as those of OpenDRIVE files do, in capitals or not.
inline bool is_opendrive_name(const std::filesystem::path& file) { return lower(file.extension().string()) == ".xodr"; }

/// convert_opendrive() that throws Error naming file, place and reason.
RoadConversion convert_roads(const std::filesystem::path& opendrive, const std::filesystem::path& scene,
                             const ConvertOptions& options);

}  // namespace vesper::roads
