// Luminance of a picture on the retina. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "render/tone_mapper.h"

namespace vesper::render {

/// Luminance, cd/m^2, of a picture after the light that an eye scatters; without an eye that of the picture itself.
/// Pixels that are not finite and those of negative luminance have no light. Throws Error.
std::vector<float> retinal_luminance(ToneMapper&, const HostPicture&, const std::optional<eye::ScatterSettings>& eye);

/// Pixels of a degree about the axis of a picture. Throws Error if they are not square within 1 %.
double pixels_per_degree(const HostPicture&);

}  // namespace vesper::render
