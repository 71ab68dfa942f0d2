// From scene luminance to display codes. SPDX-License-Identifier: MIT
#pragma once

#include "render/frame_context.h"
#include "shared/composite.h"
#include "vision/display.h"

namespace vesper::render {

struct CompositeInputs {
    graph::Resource scene;  ///< cd/m^2
    graph::Resource curve;
    graph::Resource bloom;  ///< optional: of add_bloom; added after the curve
};

struct CompositeSettings {
    uint32_t tone = 0;  ///< shared::kTone* and shared::kGamut*
    vision::Display display;
    float bloom_gain = 1;
    bool blue_first = false;  ///< codes have blue in their lowest bits, and red in the highest
};

/// Maps scene luminance to display codes: tone curve, colour at the mapped luminance (as the bits shared::kGamut* have
/// it where the display cannot show that colour as bright; nearer to grey where it lies outside its primaries), bloom,
/// and the codes of the display. One word per pixel, r32ui, red in its lowest bits: 8 bits a channel and alpha 255, or
/// 10 bits and alpha 3. A channel's code is the whole number nearest to the exact value. Pixels that are not finite
/// show the darkest.
graph::Resource add_composite(const FrameContext& frame, const CompositeInputs& inputs,
                              const CompositeSettings& settings);

/// The light that add_composite gives codes to, rgba32f: RGB in the display's primaries, each 0 at the display's
/// darkest luminance and 1 at its brightest.
graph::Resource add_shown_light(const FrameContext& frame, const CompositeInputs& inputs,
                                const CompositeSettings& settings);

/// What add_composite shows without the limits of the display, rgba32f, cd/m^2 in Rec. 709: the light that it would
/// emit and reflect if it had every colour and no peak. Where it is not wanted there is none.
graph::Resource add_display_light(const FrameContext& frame, const CompositeInputs& inputs,
                                  const CompositeSettings& settings, bool wanted = true);

}  // namespace vesper::render
