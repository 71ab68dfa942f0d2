// Sizes and angles of pictures, as commands take them. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <vulkan/vulkan_core.h>

#include "io/hdr_image.h"

namespace vesper {

/// WIDTHxHEIGHT, px, with sides from `least` to `most`. Throws Error.
VkExtent2D parse_size(const std::string& text, unsigned least = 1, unsigned most = 16384);

/// Angle a picture covers in height, degrees: as given (0: not), as Vesper's own pictures say, or 40.
double fov_of(const HdrImage& image, double given);

/// cd/m^2 of a picture's 1.0: as given (0: not), as the file says, or 1.
double scale_of_picture(const HdrImage& image, double given);
/// Says on standard error that neither told.
void note_unknown_unit(const std::string& file);

}  // namespace vesper
