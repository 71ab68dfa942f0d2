// What every operator says of itself, in its file of this folder. SPDX-License-Identifier: MIT
//
// engine/render/operators/NAME.h defines NameSettings for every line of vesper/operators.h, with
//   traits                     what the operator needs of the tone chain
//   fields, with defaults      what users may set
//   options(visit)             calls visit(&NameSettings::field, OperatorOption) for each of them; static
//   block(Display)             the settings as glsl/operators/NAME.glsl reads them; may be left out
//   counts_finely()            whether it uses the histogram as set, beside traits.histogram; may be left out
//   check()                    throws Error for settings that contradict each other; may be left out
//   shown(ToneCurve, cd/m^2)   displayed light of a grey pixel, 0 for the darkest and 1 for the brightest; may be left
//                              out where the nodes of the curve are luminances of the display
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "shared/photometry.h"
#include "shared/tone.h"
#include "vision/display.h"

namespace vesper::render {

struct OperatorTraits {
    uint32_t form = shared::kToneCurve;      ///< how pixels are mapped: shared::kTone*, or the operator's own value
    uint32_t ceiling = shared::kCeilingEye;  ///< default of the thresholds: shared::kCeiling*
    uint32_t adapt_to = shared::kAdaptGaze;  ///< default of what the eye adapts to: shared::kAdapt*
    bool remembers = false;  ///< the picture depends on the frames before, and not only to smooth flicker
    bool histogram = false;  ///< it adjusts a histogram
    bool chromatic = false;  ///< the eye adapts to the colour it looks at
    bool bands = false;      ///< contrast is mapped in bands (add_bands), and only what lies above them by the curve
};

/// A setting as users read it: a number from `low` to `high`, or a switch.
struct OperatorOption {
    const char* name;  ///< "devlin_contrast"
    const char* unit = "";
    const char* help = "";
    double low = 0, high = 1;
};

/// The table of a curve at a luminance, cd/m^2, between its nodes.
inline glm::dvec4 node_at(const shared::ToneCurve& curve, double luminance) {
    const double ln = std::log(std::max(luminance, double(shared::kLuminanceFloor)));
    const double at = std::clamp((ln - curve.ln_low) * double(curve.bins_per_ln), 0.0, double(curve.bins));
    const size_t below = std::min(size_t(at), size_t(curve.bins) - 1);
    return glm::mix(glm::dvec4(curve.node[below]), glm::dvec4(curve.node[below + 1]), at - double(below));
}

/// Numbers for ToneParameters::settings.
using OperatorBlock = std::array<glm::vec4, shared::kOperatorSettings>;

/// Of operators that nothing can be set of.
struct NoOptions {
    template <class Visit>
    static void options(const Visit&) {}
};

}  // namespace vesper::render
