// Visibility of small targets (Adrian 1989). SPDX-License-Identifier: MIT
#pragma once

#include <optional>

namespace vesper::vision {

/// A uniform target on a uniform background, with observer and time of observation.
struct Target {
    double size = 10;          ///< diameter, arc minutes
    double seconds = 0.2;      ///< time of observation
    double age = 23;           ///< years, of the observer
    bool darker = false;       ///< than its background
    double probability = 2.6;  ///< k: 1 for 50 % detection, 2.6 for certain detection
};

/// Smallest luminance difference to a background of `background` cd/m^2 at which the target is seen, cd/m^2 (Adrian
/// 1989).
double target_threshold(double background, const Target& target = {});

/// Visibility level: the difference over the threshold; negative where the target is darker. cd/m^2. `target.darker` is
/// ignored.
double visibility_level(double target_luminance, double background, Target target = {});

constexpr double kLargestTarget = 60;                                    ///< arc minutes, as Adrian has it
constexpr double kDarkestBackground = 1e-4, kBrightestBackground = 1e4;  ///< cd/m^2, of this program

/// The same within bounds: a target of more than kLargestTarget counts as one of that size. Nothing for a background
/// that is not of kDarkestBackground to kBrightestBackground, and where the formula gives no threshold above 0.
std::optional<double> bounded_visibility_level(double target_luminance, double background, Target target = {});

/// Diameter of a disc of a solid angle, arc minutes.
double disc_minutes(double steradians);

}  // namespace vesper::vision
