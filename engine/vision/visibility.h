// Visibility of small targets (Adrian 1989). SPDX-License-Identifier: MIT
#pragma once

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

}  // namespace vesper::vision
