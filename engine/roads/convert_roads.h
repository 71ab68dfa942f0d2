// An OpenDRIVE file to a scene file. SPDX-License-Identifier: MIT
#pragma once

#include <vesper/roads.hpp>

namespace vesper::roads {

/// convert_opendrive() that throws Error naming file, place and reason.
RoadConversion convert_roads(const std::filesystem::path& opendrive, const std::filesystem::path& scene,
                             const ConvertOptions& options);

}  // namespace vesper::roads
