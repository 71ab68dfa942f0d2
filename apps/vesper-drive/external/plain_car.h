// Bodies for what a scene has no model of: boxes with lamps. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "scene/scene.h"
#include "traffic/world_file.h"

namespace vesper::drive {

/// A box of this size, its middle at `centre` (ahead, left, up; m) from the node's origin on the ground.
struct PlainBody {
    glm::dvec3 size{4.4, 1.8, 1.5};  ///< length, width, height, m
    glm::dvec3 centre{0, 0, 0.75};
    glm::vec3 reflectance{0.3f};
    bool lamps = true;  ///< a car's; without: a person or a thing
};

/// Names of the lamps that plain bodies have.
traffic::LampRoles plain_lamps();

/// Gives a node the body of that name, which the scene has once, and, at its corners, low and high beams and front fog
/// lamps (standard_lamp), tail, brake and reversing lamps, rear fog lamps and indicators. The candela are those of UN
/// Regulations 6, 7, 23 and 38, as data/rivoli has them.
void add_plain_body(scene::Scene&, uint32_t node, const std::string& name, const PlainBody&);

}  // namespace vesper::drive
