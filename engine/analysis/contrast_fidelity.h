// What a display shows of the contrast of a scene, and what it adds. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "analysis/visual_channels.h"

namespace vesper::analysis {

/// Of a scene and a picture of it on a display. Each is seen by an eye that is adapted to it, so that contrast is
/// compared and not luminance (Aydin, Mantiuk, Myszkowski and Seidel 2008, with the channels of visit_channels()).
/// Contrast of a place in an octave of frequency is seen from kSeen thresholds on, and not seen below one threshold of
/// a grating. Luminance of regions, and what lies above the octaves, is left out. By pixel the share of the octaves in
/// which contrast is ...
struct ContrastFidelity {
    std::vector<float> seen;       ///< seen in the scene
    std::vector<float> lost;       ///< seen in the scene, and not on the display
    std::vector<float> invented;   ///< seen on the display, and not in the scene
    std::vector<float> amplified;  ///< seen in the scene, and kAmplified times as many thresholds on the display
};
constexpr double kSeen = 2;  ///< thresholds: a single wave needs more than a grating does
constexpr double kAmplified = 2;

/// `pair.first` is the scene, `pair.second` the display.
ContrastFidelity contrast_fidelity(const PicturePair& pair, const ContrastEye& eye = {});

double mean_of(const std::vector<float>& shares);

}  // namespace vesper::analysis
