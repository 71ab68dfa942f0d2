// Sizes and angles of pictures, as commands take them. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "io/hdr_image.h"

namespace vesper {

/// WIDTHxHEIGHT, px, with sides from `least` to `most`. Throws Error.
VkExtent2D parse_size(const std::string& text, unsigned least = 1, unsigned most = 16384);

/// Of the option that names a layer of an OpenEXR file, as read_hdr_image takes it.
constexpr const char* kLayerHelp = "OpenEXR: name of the layer or part to take (default: the one without a name, or the only one)";

/// What the values of a picture and its height stand for.
struct PictureMeaning {
    double scale = 1;                ///< cd/m^2 of its 1.0: as given, as the file says, or 1
    double fov = 40;                 ///< angle it covers in height, degrees: as given, as the file says (Vesper's pictures and Radiance's), or 40
    std::vector<std::string> notes;  ///< what was taken for granted, and what of the file was passed over
};
/// `scale` and `fov` as given, 0: not. Whether the angle was guessed is noted only where it matters.
PictureMeaning meaning_of(const HdrImage&, double scale, double fov, bool angle_matters);

}  // namespace vesper
