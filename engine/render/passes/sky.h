// A sky that is a picture, and its light on surfaces. SPDX-License-Identifier: MIT
#pragma once

#include "render/passes/gbuffer.h"

namespace vesper::render {

/// A sky map on the device.
struct SkyTexels {
    graph::Resource texels;   ///< rgba32f, as shared/sky.h says; none: there is no such sky
    uint32_t sharp_side = 0;  ///< of its sharp map
    float lambert = 0;        ///< as in ShadeSettings; 0: no diffuse reflection, which is added elsewhere
};

/// Adds the sky to shaded luminance, in place: the sky itself where there is no surface; E(normal) rho lambert and
/// specular reflection on surfaces. Without a sky returns `scene`.
graph::Resource add_sky(const FrameContext& frame, const GBuffer& surfaces, graph::Resource scene,
                        const SkyTexels& sky);

}  // namespace vesper::render
