// Uniform light from all directions in scenes with tunnels. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "render/passes/gbuffer.h"
#include "scene/tunnel.h"

namespace vesper::render {

struct DaylightSettings {
    std::vector<scene::Tunnel> tunnels;
    glm::vec3 illuminance{0};  ///< RGB lx, on any surface in the open
    float lambert = 0;         ///< as in ShadeSettings
};

/// Adds uniform light to shaded luminance, in place: E rho lambert. In a tunnel only light through its ends arrives;
/// interreflection is not counted. Without tunnels returns `scene`: ShadeSettings::ambient is the same light.
graph::Resource add_daylight(const FrameContext& frame, const GBuffer& surfaces, graph::Resource scene,
                             const DaylightSettings& settings);

}  // namespace vesper::render
