// Street lamps: poles, arms and measured light. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include "roads/lit_road_parts.h"

namespace vesper::roads {

/// A lamp whose pole stands on the frame's origin, its arm towards +y (`towards` 1) or -y (-1), its light `height` m
/// up.
void add_street_lamp(RoadBuild& build, const BodyFrame& frame, double height, int towards);

/// A node whose X, Y and -Z lie along these axes of the file's frame.
scene::Node node_at(const RoadBuild& build, const std::string& name, glm::dvec3 position, glm::dvec3 x, glm::dvec3 y,
                    glm::dvec3 z);

}  // namespace vesper::roads
