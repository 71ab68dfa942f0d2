// The surfaces that the view sees. SPDX-License-Identifier: MIT
#pragma once

#include "gpu_scene/gpu_scene.h"
#include "render/frame_context.h"

namespace vesper::render {

/// Surfaces seen by each pixel.
struct GBuffer {
    graph::Resource
        reflectance;  ///< rgba16f: base colour [0, 1]; metallic [0, 1] or a kind of surface (shared/shade.h)
    graph::Resource
        surface;  ///< rgba32f: view-frame normal, octahedral (2), depth along the view axis (m; 0: nothing), roughness
    graph::Resource emission;  ///< rgba32f: emitted RGB luminance, cd/m^2
    graph::Resource depth;     ///< d32: near / depth, 0 at infinity
    graph::Resource
        triangle;  ///< rg32ui: 1 + its instance, 0 where nothing is drawn; its first vertex, see LeadingVertices
    graph::Resource instances;  ///< shared::Instance, as rgba32f texels
};

/// Rasterizes the parts of the scene in view, at the poses of `poses`. Textures are filtered as linear reflectance.
GBuffer add_gbuffer(const FrameContext& frame, const gpu_scene::GpuScene& scene, const gpu_scene::SceneFrame& poses);

}  // namespace vesper::render
