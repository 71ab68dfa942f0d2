// Faces of traffic signs. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include "roads/road_mesh.h"

namespace vesper::roads {

/// A sign's panel, its back 5 cm before the plane x = 0 of the frame, looking along +x (a reader has +y to the right),
/// its bottom edge at z = 0. Speed limits show their number, known signs their shape and colours, others a white panel.
void add_sign(RoadMesh& mesh, const BodyFrame& frame, const RoadSignal& signal, double width, double height);

/// True if the signal is painted on the road, such as stop lines.
bool is_painted(const RoadSignal& signal);
/// True if signs of the kind stand on the ground, such as beacons and barriers.
bool stands_on_ground(const RoadSignal& signal);
/// True for a traffic light; true for one for pedestrians.
bool is_traffic_light(const RoadSignal& signal);
bool is_for_pedestrians(const RoadSignal& signal);

}  // namespace vesper::roads
