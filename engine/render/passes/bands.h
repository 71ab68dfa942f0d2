// Contrast in bands. SPDX-License-Identifier: MIT
#pragma once

#include "render/passes/pyramid.h"
#include "shared/tone.h"

namespace vesper::render {

struct BandsSettings {
    bool on = true;
    uint32_t tone = 0;  ///< kToneCurve and how dim light is perceived
    shared::ToneParameters parameters{};
};

/// The scene as bands of contrast between the levels of the pyramid (log averages), up to the foveal one, each with the
/// visibility level it has in the scene: contrast over the least that cones adapted to a texel of the level above see,
/// and on the display cones adapted to 0.3 of its white (Ferwerda et al. 1996; Grave and Bremond 2008, reconstructed),
/// linear between such texels; never more contrast than in the scene. Luminance above the bands is mapped by `curve`.
/// rgba32f, cd/m^2 on the display, before its limits. Where bands are not on, returns `scene`.
graph::Resource add_bands(const FrameContext& frame, graph::Resource scene, const Pyramid& pyramid,
                          uint32_t foveal_level, graph::Resource curve, const BandsSettings& settings);

}  // namespace vesper::render
