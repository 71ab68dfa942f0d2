// How much of what is drawn a view sees. SPDX-License-Identifier: MIT
#pragma once

#include "gpu_scene/gpu_scene.h"

namespace vesper::render {

/// Counts of one view. A part is one of one placement.
struct SeenTriangles {
    uint64_t parts = 0, triangles = 0;            ///< that are drawn: their spheres reach into the view
    uint64_t seen_parts = 0, seen_triangles = 0;  ///< that are in front at the middle of some pixel
};
/// Of a scene with everything at its pose of `poses`, drawn for it. Throws Error if the device fails.
SeenTriangles seen_triangles(gpu::Device& device, const gpu_scene::GpuScene& scene, const gpu_scene::SceneFrame& poses,
                             const gpu_scene::View& view);

}  // namespace vesper::render
