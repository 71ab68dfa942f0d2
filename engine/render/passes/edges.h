// Pixels that several surfaces fill. SPDX-License-Identifier: MIT
#pragma once

#include "render/passes/gbuffer.h"

namespace vesper::render {

/// Replaces the luminance of pixels beside edges, cd/m^2, by the mean over what fills them, at shared::kEdgeSamples
/// points: whose facet each point sees is found among those that the pixel and its eight neighbours see in their
/// middles, and what these middles show is its luminance. A pixel that sees a single surface keeps its bits. What no
/// middle sees is not found; it may hide light, so that the sum over all pixels is not quite what it was.
void add_edges(const FrameContext& frame, const gpu_scene::GpuScene& scene, const GBuffer& surfaces,
               graph::Resource luminance);

}  // namespace vesper::render
