// Distance maps of a scene's lamps, kept from frame to frame. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "gpu/buddy_allocator.h"
#include "gpu/graphics_pipeline.h"
#include "gpu/kernel_cache.h"
#include "gpu_scene/lamp_maps.h"
#include "graph/executor.h"
#include "render/passes/visibility.h"

namespace vesper::render {

/// Owns the maps on the device. Their sizes depend on the view, their contents on the scene alone. Not thread-safe.
class DistanceMaps {
public:
    static constexpr uint64_t kMostTexels = 48u << 20u;  ///< 96 MiB, and 24 MiB of bounds

    DistanceMaps(gpu::Device& device, const gpu_scene::GpuScene& resident,
                 const std::vector<gpu_scene::PlacedLamp>& lamps, const gpu_scene::MapPlan& plan);

    /// Lamps that shine and whose maps are out of date: they, or something in the scene, have moved since they were
    /// drawn, or the view wants another size. These must be drawn before maps() is used. Throws Error where the maps of
    /// all lamps do not fit kMostTexels.
    std::vector<uint32_t> outdated(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses);
    /// Draws the maps of lamps, while no frame uses any map, and waits. Throws Error.
    void draw(const std::vector<uint32_t>& lamps, const gpu_scene::SceneFrame& poses);
    /// The maps of the lamps of a list, for a frame of `view`.
    VisibilityMaps maps(graph::FrameGraph& graph, const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses,
                        const gpu_scene::View& view) const;

    uint64_t bytes() const { return arena_.bytes() + executor_.heap_bytes(); }  ///< of device memory

private:
    void place(std::vector<uint32_t> resized, const gpu_scene::LampList& list);

    const gpu_scene::GpuScene& resident_;
    const std::vector<gpu_scene::PlacedLamp>& lamps_;
    const std::vector<std::vector<uint32_t>>& fixtures_;
    std::vector<gpu_scene::MapLayout> layouts_;  // of each lamp; side 0: it has no place
    uint64_t texels_;                            // of the buffers
    gpu::BuddyAllocator places_;
    gpu::Arena arena_;
    gpu::OwnedBuffer distances_, bounds_;
    std::vector<glm::dmat4> drawn_world_;  // of nodes, when maps were last drawn
    std::vector<bool> drawn_;              // of lamps: the map is that of drawn_world_
    gpu::KernelCache kernels_;
    gpu::GraphicsPipelineCache pipelines_;
    graph::Executor executor_;
};

}  // namespace vesper::render
