// The eye adapts, and the tone curve follows. SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <glm/glm.hpp>

#include "render/eye_state.h"
#include "render/passes/colours.h"
#include "render/passes/histogram.h"
#include "render/passes/operators.h"
#include "shared/gamut.h"
#include "vision/display.h"
#include "vision/eye.h"

namespace vesper::render {

struct ToneSettings {
    OperatorSettings operators;
    bool colour_loss = false;    ///< dim light loses its colour
    bool acuity_loss = false;    ///< dim light is blurred as far as it cannot be resolved
    bool purkinje = false;       ///< dim light is weighted as rods do
    bool photopic_rods = false;  ///< rods take luminance for scotopic luminance, as in pfstools; without: that of the
                                 ///< colour, and of white for what the eye adapts to
    uint32_t gamut =
        shared::kGamutLuminance;  ///< shared::kGamut*: what gives way where the display is not as bright in a colour
    vision::Observer observer;    ///< whose eye it is
    glm::vec2 gaze{0.5f};         ///< where it looks, parts of the image from its top left
    std::optional<uint32_t> adapt_to;  ///< shared::kAdapt*; default: as the operator has it
    std::optional<uint32_t> ceiling;   ///< shared::kCeiling*; default: as the operator has it
    float smoothing_seconds = 0.15f;   ///< of the curve, against flicker; not a model of the eye; 0: none
};

/// Where on the pyramid one degree is.
struct FovealView {
    uint32_t level;     ///< 1-based
    VkExtent2D texels;  ///< of that level
    VkExtent2D image;   ///< px
};

shared::ToneParameters tone_parameters(const OperatorInfo&, const HistogramSettings&, const ToneSettings&,
                                       const vision::Display&, const FovealView&, float seconds);

struct AdaptationInputs {
    graph::Resource whole;  ///< the 1x1 level of the pyramid
    graph::Resource fovea;  ///< the texels of the foveal level about the gaze, or all
    graph::Resource histogram;
    Colours colours = {};  ///< of operators whose eye adapts to colour
    EyeState eye = {};
};

struct Adaptation {
    graph::Resource curve;  ///< shared::ToneCurve
    graph::Resource eye;    ///< shared::EyeState after the frame
};

/// Lets the eye adapt to the light where it looks (vision/eye.h; exact for any time step, at once in the first frame),
/// and turns that and the histogram into a tone curve, smoothed over time, or into the parameters of the operator's
/// form.
Adaptation add_adaptation(const FrameContext& frame, const AdaptationInputs& inputs, const OperatorInfo& op,
                          shared::ToneParameters parameters);

}  // namespace vesper::render
