// Light of headlamps on the road, from above. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "approach.h"

namespace vesper::commands {

/// Draws horizontal illuminance of a beam's lamps before the car on a level road at the height of the origin of the
/// car, without shadows: in false colours with lines of equal illuminance, up to `reach` m before the eye. Throws
/// Error.
void save_beam_plot(const std::string& file, const std::string& title, const Approach&, size_t beam, double reach);

}  // namespace vesper::commands
