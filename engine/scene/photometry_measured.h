// Rules that put measured lamps on nodes. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include "scene/json_value.h"
#include "scene/photometry.h"

namespace vesper::scene {

/// Reads what a rule of type "distribution" says of the lamp: its file, flux and pose. Colour is for the caller.
void read_measured(const JsonValue& source, const std::filesystem::path& folder, Photometry& made, LampRule& rule);

/// From the lamp's frame to that of a node with this transform to the world. A lamp of type C whose rule states no
/// direction keeps -Z within 45 degrees of straight down; elsewhere it is turned down, the shortest way from -Z.
glm::dquat turn_of(const LampRule& rule, const glm::dmat4& world);
/// Whether that is a turn which the rule does not state.
bool is_turned_down(const LampRule& rule, const glm::dmat4& world);

/// The shortest turn from -Z to an axis.
glm::dquat turn_to(glm::dvec3 axis);

}  // namespace vesper::scene
