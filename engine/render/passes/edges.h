// Pixels that several surfaces fill. SPDX-License-Identifier: MIT
#pragma once

#include "render/passes/gbuffer.h"

namespace vesper::render {

/// Replaces the luminance of pixels beside edges, cd/m^2, by the mean over what fills them, at so many points, up
/// to shared::kEdgeSamples: whose facet each point sees is found among those that the pixel and its eight neighbours
/// see in their middles, and what these middles show is its luminance. A facet that is narrower than a pixel, or
/// has holes at unknown places, fills the pixel whose middle sees it: what is thin is seen by some middles only, and so
/// keeps its light in the mean over many. A pixel that sees a single surface keeps its bits. Nothing is done, and
/// nothing said, where a buffer of the device has no room for a vec4 of each pixel (gpu::Device::most_texels: with
/// short texel buffers of 128 MiB, 8.4 million pixels), or has_facets() says no.
void add_edges(const FrameContext& frame, const GBuffer& surfaces, graph::Resource luminance, uint32_t points);

}  // namespace vesper::render
