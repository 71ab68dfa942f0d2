// How much of what is drawn a view sees. SPDX-License-Identifier: MIT
#pragma once

#include "gpu/graphics_pipeline.h"
#include "gpu/kernel_cache.h"
#include "gpu_scene/gpu_scene.h"

namespace vesper::render {

/// Counts of one view. A part is one of one placement.
struct SeenTriangles {
    uint64_t parts = 0, triangles = 0;            ///< that are drawn: their spheres reach into the view
    uint64_t seen_parts = 0, seen_triangles = 0;  ///< that are in front at the middle of some pixel
};
/// Counts them, with pipelines of its own that it keeps.
class TriangleCounter {
public:
    explicit TriangleCounter(gpu::Device& device) : device_(device), kernels_(device), pipelines_(device) {}
    /// Of a scene with everything at its pose of `poses`, drawn for it. Throws Error if the device fails.
    SeenTriangles count(const gpu_scene::GpuScene& scene, const gpu_scene::SceneFrame& poses,
                        const gpu_scene::View& view) const;

private:
    gpu::Device& device_;
    gpu::KernelCache kernels_;
    gpu::GraphicsPipelineCache pipelines_;
};

}  // namespace vesper::render
