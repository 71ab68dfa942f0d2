// What is on traffic signs, in a few shapes. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include "roads/road_mesh.h"

namespace vesper::roads {

/// A sign's panel, its back 5 cm before the plane x = 0 of the frame, looking along +x (who reads it has +y to the
/// right), its bottom edge at z = 0. Speed limits show their number, known signs their shape and colours, others a
/// white panel.
void add_sign(RoadMesh& mesh, const BodyFrame& frame, const RoadSignal& signal, double width, double height);

/// Whether the signal is painted on the road (stop lines and the like) rather than put up.
bool is_painted(const RoadSignal& signal);
/// Whether it is a traffic light, and for people on foot.
bool is_traffic_light(const RoadSignal& signal);
bool is_for_pedestrians(const RoadSignal& signal);

}  // namespace vesper::roads
