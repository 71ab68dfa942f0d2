// Luminance of a picture on the retina. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "render/tone_mapper.h"

namespace vesper::render {

/// Luminance, cd/m^2, of a picture after the light that an eye scatters; without an eye that of the picture itself. Of
/// pixels that are not finite it is 0. Throws Error.
std::vector<float> retinal_luminance(ToneMapper&, const HostPicture&,
                                     const std::optional<gpu_scene::ScatterSettings>& eye);

/// Pixels of a degree in the middle of a picture of so many rows that covers an angle in height, rad.
double pixels_per_degree(uint32_t height, double vertical_fov);

}  // namespace vesper::render
