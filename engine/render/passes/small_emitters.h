// Emitting surfaces that are about as small as a pixel. SPDX-License-Identifier: MIT
#pragma once

#include "gpu_scene/small_emitters.h"
#include "render/passes/gbuffer.h"

namespace vesper::render {

/// Adds to the scene image, in place, what the emitters of `list` emit: their luminance, cd/m^2, times the part of each
/// pixel that their silhouette covers, exactly, and the part of that which nothing hides, at shared::kEdgeSamples
/// points. What hides it is found among the facets that the pixel and its eight neighbours see in their middles, as
/// add_edges does. `surfaces` must be without their emission. Without emitters returns `luminance`; with them
/// has_facets() must hold.
graph::Resource add_small_emitters(const FrameContext& frame, const GBuffer& surfaces, graph::Resource luminance,
                                   const gpu_scene::SmallEmitterList& list);

}  // namespace vesper::render
