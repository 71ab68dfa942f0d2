// Names of lamps. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "scene/scene.h"

namespace vesper::drive {

/// The name that rules and settings know the lamp of a node by.
inline const std::string& lamp_name(const scene::Scene& scene, uint32_t node) {
    const scene::Lamp& lamp = scene.lamps[scene.nodes[node].lamp];
    return lamp.kind == scene::Lamp::Kind::Measured || lamp.name.empty() ? scene.nodes[node].name : lamp.name;
}

}  // namespace vesper::drive
