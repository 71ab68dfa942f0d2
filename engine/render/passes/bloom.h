// Bloom, the glare of the LDR baseline. SPDX-License-Identifier: MIT
#pragma once

#include "render/frame_context.h"
#include "shared/bloom.h"
#include "vision/display.h"

namespace vesper::render {

struct BloomSettings {
    float threshold = 0.9f;       ///< light of its brightest channel, relative to white, from which a pixel glares
    float sigma_degrees = 0.35f;  ///< of the Gaussian
    float gain = 1;               ///< 0: no bloom, no pass
};

/// The paper's glare: the tone-mapped image where it reaches `threshold`, blurred by a normalised Gaussian. Displayed
/// light (relative), rgba16f at a quarter of the resolution. `tone` is one of shared::kTone*. Without gain there is
/// none.
graph::Resource add_bloom(const FrameContext& frame, graph::Resource scene, graph::Resource curve, uint32_t tone,
                          const vision::Display& display, const BloomSettings& settings);

}  // namespace vesper::render
