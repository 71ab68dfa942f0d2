// Radiosity from a file, checked before it is used. SPDX-License-Identifier: MIT
#pragma once

#include "transport/radiosity.h"

namespace vesper::transport {

/// Lists have the sizes that belong together, indices lie in them, the grid has the cells, and numbers are finite and
/// in their ranges: no function of Radiosity reads beyond a list or divides by 0.
bool is_sound(const Radiosity&);
/// Sources and bodies are nodes of a scene.
bool names_nodes_of(const Radiosity&, const scene::Scene&);

}  // namespace vesper::transport
