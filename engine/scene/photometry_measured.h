// Rules that put measured lamps on nodes. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include "scene/json_value.h"
#include "scene/photometry.h"

namespace vesper::scene {

/// Reads what a rule of type "distribution" says of the lamp: its file, flux and pose. Colour is for the caller.
void read_measured(const JsonValue& source, const std::filesystem::path& folder, Photometry& made, LampRule& rule);

/// The shortest turn from -Z to an axis.
glm::dquat turn_to(glm::dvec3 axis);

}  // namespace vesper::scene
