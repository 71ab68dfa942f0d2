// What a tone curve does to one luminance, on the host. SPDX-License-Identifier: MIT
#pragma once

#include "shared/tone.h"
#include "vision/display.h"

namespace vesper {

/// Luminance of the display, cd/m^2, for a neutral scene luminance, cd/m^2. `form`: one of shared::kTone*.
double shown_luminance(const shared::ToneCurve& curve, uint32_t form, double luminance, const Display& display);

}  // namespace vesper
