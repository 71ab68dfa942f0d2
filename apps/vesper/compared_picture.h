// Pictures to compare: luminance from HDR files, and from codes of a display. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arguments/display_arguments.h"
#include "arguments/picture_arguments.h"
#include "render/tone_mapper.h"

namespace vesper::commands {

struct CompareSource {
    apps::ScaleArguments scale;  ///< of files without a unit
    apps::DisplayArguments display;
    std::string layer;
    double fov = 0;  ///< degrees in height; 0: as the files say
};

/// A picture in cd/m^2.
struct ComparedPicture {
    VkExtent2D extent{};
    std::vector<float> rgb;                     ///< cd/m^2 in linear Rec. 709, rows from the top
    std::optional<vision::ImageAngles> angles;  ///< of its edges; none: neither option nor file tells them
    bool codes = false;                         ///< of a PNG
    std::string source;                         ///< of its unit, for the report
};

/// Reads OpenEXR and Radiance files that state their unit, or for which --unit does, and PNG files as codes of the
/// display. Prints notes. Throws Error, naming the file, for others.
ComparedPicture read_compared(const CompareSource&, const std::string& file);

/// What two pictures cover. Throws Error if neither is known, or if they differ.
vision::ImageAngles angles_of(const ComparedPicture& a, const ComparedPicture& b);

}  // namespace vesper::commands
