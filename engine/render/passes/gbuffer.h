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
        triangle;  ///< rg32ui: 1 + its instance, 0 where nothing is drawn; its first vertex, see ProvokingVertices
    graph::Resource slope;  ///< r32ui, halves: the change of the inverse depth of the triangle's plane with a step of a
                            ///< pixel right and down, over itself, times shared::kSlopeScale
    graph::Resource instances;         ///< shared::Instance, as rgba32f texels
    graph::Resource vertices, facets;  ///< of the scene, as rg32f and rgba32ui texels; if has_facets()
    graph::Resource masks;             ///< of the scene, as r32ui texels (shared/masks.h)
};

/// Whether the device has room for texel buffers of all vertices and facets, and of as many small emitters as there
/// may be.
bool has_facets(const gpu::Device& device, const gpu_scene::GpuScene& scene);

/// Rasterizes the parts of the scene in view, at the poses of `poses`. Textures are filtered as linear reflectance.
/// `without_emission`: parts that emit nothing, by number, counted over all parts of GpuScene::placements(), ascending.
GBuffer add_gbuffer(const FrameContext& frame, const gpu_scene::GpuScene& scene, const gpu_scene::SceneFrame& poses,
                    std::span<const uint32_t> without_emission = {});

}  // namespace vesper::render
