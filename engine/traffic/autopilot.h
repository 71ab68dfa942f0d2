// A driver who keeps to a lane and to the distance. SPDX-License-Identifier: MIT
#pragma once

#include "traffic/car_following.h"
#include "traffic/course.h"
#include "traffic/vehicle.h"

namespace vesper::traffic {

struct AutopilotSettings {
    CarFollowing following;
    double preview = 0.9;            ///< looks so far ahead, s
    double least_preview = 4;        ///< but at least so far, m
};

/// What to do with a leader `gap` m ahead that is approached by `closing` m/s (no leader: an infinite gap). Steers to a point of
/// the lane ahead (pure pursuit, Coulter 1992) and follows as car_following.h says.
VehicleControls steer_along(const Course&, const VehicleState&, const VehicleParameters&, const AutopilotSettings&, double gap, double closing);

}  // namespace vesper::traffic
