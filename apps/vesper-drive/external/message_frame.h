// From the frame of another program's messages to the world, and back. SPDX-License-Identifier: MIT
#pragma once

#include "external/message_source.h"

namespace vesper::drive {

/// From the frame of messages to the world: m, rad.
struct MessageFrame {
    double yaw = 0;    ///< of its x axis against that of the roads
    glm::dvec3 at{0};  ///< of its origin, in the world
    glm::dvec3 point(const glm::dvec3&) const;
    glm::dvec3 back(const glm::dvec3&) const;  ///< from the world
};

/// `roads`: the world's origin in the frame of the roads.
MessageFrame frame_of(const MessageSource&, const glm::dvec3& roads);

}  // namespace vesper::drive
