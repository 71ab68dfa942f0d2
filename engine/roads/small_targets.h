// Visibility of small targets on a road layout (ANSI/IESNA RP-8-00), in the frame of road_layout.h.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "roads/road_layout.h"

namespace vesper::roads {

/// The target and its observer (RP-8-00): an upright square, m, seen for a time, s, from a place before it, m, by an
/// eye of an age, years.
constexpr double kTargetSide = 0.18, kTargetDistance = 83.07, kTargetEyeHeight = 1.45, kTargetTime = 0.2,
                 kTargetAge = 60;
/// The point of the road that this eye sees just above the target, m beyond it.
constexpr double kBeyondTarget = 11.77;
/// RP-8-00 has a veil of 10 E/theta^2 for every age. This is the age, years, at which EN 13201-3 has it, too.
constexpr double kTargetVeilAge = 23;

/// Throws Error if the reflectance of targets is not from 0.01 to 1.
void check_target_reflectance(double reflectance);
/// Targets on the points of the calculation field. What occluders hide from the centre of a target, from a point of its
/// background or from the eye of its observer does not shine there; sight of the target is free. Throws Error if a
/// value is out of range.
SmallTargetVisibility small_target_visibility(const LoadedLayout&, double reflectance = 0.5);
/// STV of visibility levels: -10 lg of the mean of 10^(-0.1 |VL|) of the targets that have one; nothing if none has.
std::optional<double> small_target_average(std::span<const SmallTarget>);

}  // namespace vesper::roads
