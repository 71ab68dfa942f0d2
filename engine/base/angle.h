// Angles: constants, and what lies between two. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>

namespace vesper {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTwoPi = 2 * kPi;  ///< rad, a full turn
inline constexpr double kRadiansPerDegree = kPi / 180;
inline constexpr double kDegreesPerRadian = 180 / kPi;

/// From one angle to another the short way, the part `f` of it, rad.
inline double mix_angles(double from, double to, double f) { return from + f * std::remainder(to - from, kTwoPi); }

}  // namespace vesper
