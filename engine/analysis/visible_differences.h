// Where an observer tells two pictures apart. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "analysis/visual_channels.h"

namespace vesper::analysis {

/// Of two pictures of luminance.
struct VisibleDifferences {
    std::vector<float> probability;  ///< that a difference is detected by an eye that looks there, by pixel
    double largest = 0;              ///< probability
    uint32_t x = 0, y = 0;           ///< px, of the largest difference itself
    double above_half = 0, above_75 = 0, above_95 = 0;  ///< shares of the pixels with a larger probability
};

/// Visible differences after Mantiuk, Daly, Myszkowski and Seidel 2005 (HDR-VDP), with choices of our own: Barten's
/// sensitivity, a steerable pyramid in place of the cortex transform, responses in quadrature in place of phase
/// uncertainty, and sums of energy over channels and over the area of Barten's eye in place of sums of probability.
/// Differences of a channel are masked by the weaker response of the two pictures. A place differs by at most twice the
/// largest JND of the pixels that its fovea sees. docs/compare.md says what was tested.
VisibleDifferences visible_differences(const PicturePair&, const ContrastEye& = {});

/// How much a response of so many thresholds raises the threshold of the channel: 1 without one, and with a slope of
/// 0.7 in logarithms far above (Daly 1993, of learned noise).
double threshold_elevation(double response);

}  // namespace vesper::analysis
