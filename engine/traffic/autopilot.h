// An autopilot that keeps to a lane and a distance. SPDX-License-Identifier: MIT
#pragma once

#include "traffic/car_following.h"
#include "traffic/course.h"
#include "traffic/vehicle.h"

namespace vesper::traffic {

struct AutopilotSettings {
    CarFollowing following;
    double preview = 0.9;      ///< distance of the steering point, s
    double least_preview = 4;  ///< its least distance, m
};

/// Controls of a car behind a leader `gap` m ahead with closing speed `closing`, m/s (no leader: an infinite gap).
/// Steers to a point of the lane ahead (pure pursuit, Coulter 1992) and follows the leader (car_following.h).
VehicleControls steer_along(const Course&, const VehicleState&, const VehicleParameters&, const AutopilotSettings&,
                            double gap, double closing);

}  // namespace vesper::traffic
