// Luminance of pictures without a unit. SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace vesper::analysis {

/// Luminance of a picture, in its own unit.
struct RelativeLuminance {
    double log_average = 0;  ///< of the pixels with light; 0: there are none
    double highlights = 0;   ///< log average of the brightest hundredth of them
};

/// `rgb`: linear Rec. 709, 3 values per pixel. Pixels that are not finite or have no light do not count, nor does the
/// brightest thousandth, such as the sun. Pixels below 1e-6 of the highlights count less; below 1e-8 they do not count.
RelativeLuminance relative_luminance(std::span<const float> rgb);

/// The log average that such a scene may have, 0.1 to 3000 cd/m^2: the lower, the further the highlights stand out. The
/// same for any multiple of the picture, and continuous: with highlights `d` decades above the log average, 10^(3.5 -
/// 0.75 d). docs/tonemap.md has the reasons.
double plausible_luminance(const RelativeLuminance&);

/// cd/m^2 of the picture's 1.0 that brings its log average to plausible_luminance(), to six digits; 1 where it has no
/// light.
double plausible_scale(const RelativeLuminance&);

}  // namespace vesper::analysis
