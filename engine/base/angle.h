// Constants of angles. SPDX-License-Identifier: MIT
#pragma once

#include <numbers>

namespace vesper {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTwoPi = 2 * kPi;  ///< rad, a full turn
inline constexpr double kRadiansPerDegree = kPi / 180;
inline constexpr double kDegreesPerRadian = 180 / kPi;

}  // namespace vesper
