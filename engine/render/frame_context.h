// The frame that passes add themselves to. SPDX-License-Identifier: MIT
// Pixels count from the top left. RGB is linear Rec. 709; luminance is 0.212639 R + 0.715169 G + 0.072192 B.
#pragma once

#include "gpu/graphics_pipeline.h"
#include "gpu/kernel_cache.h"
#include "gpu_scene/view.h"
#include "graph/frame_graph.h"
#include "render/formats.h"

namespace vesper::render {

/// A frame while it is declared. Passes run in the order in which they are added.
struct FrameContext {
    graph::FrameGraph& graph;
    const gpu::KernelCache& kernels;
    const gpu::GraphicsPipelineCache& pipelines;
    gpu_scene::View view;  ///< its extent is that of every image of full size

    /// kLockstep of glsl/lanes.glsl.
    uint32_t lockstep() const { return kernels.device().has_lockstep() ? 1 : 0; }
};

}  // namespace vesper::render
