// Parts of a scene that cast shadows, and the images that they are drawn into. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "render/frame_context.h"

namespace vesper::render {

/// A buffer for so many texels of shadow maps, halves, two a word; at least one word. Bound in `arena`.
gpu::OwnedBuffer make_shadow_texels(const gpu::Device& device, gpu::Arena& arena, uint64_t texels);

/// Images and buffers in which shadow maps of lamps are drawn, one image after the other; reserved in every frame that
/// has maps, drawn or not.
struct ShadowMapScratch {
    struct Image {
        uint32_t side;          ///< texels
        graph::Resource depth;  ///< d32
        graph::Resource small;  ///< of small triangles, a float a texel
    };
    std::array<Image, 2> images;        ///< the smaller first
    graph::Resource vertices, indices;  ///< of the scene, as texels
    graph::Resource draws;              ///< VkDrawIndirectCommand, kMostQuadrants
    graph::Resource triangles;          ///< corners, m, kMostTriangles
    uint32_t drawn = 0;                 ///< images so far

    static constexpr uint32_t kMostQuadrants = 4096, kMostTriangles = 1u << 19u;  ///< of a dispatch
    /// The smallest image that holds a square of this side; throws Error if there is none.
    const Image& image_for(uint32_t side) const;
};
ShadowMapScratch add_shadow_map_scratch(const FrameContext& frame, const gpu_scene::GpuScene& scene);

/// Of casters.frag: the opacity of a masked material.
struct MaskPush {
    float base_opacity, cutoff;
};
inline constexpr VkDescriptorType kCasterTextures[]{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};

/// Instances of one part, drawn at once.
struct CasterBatch {
    uint32_t part;
    uint32_t first_instance, instance_count;
};

/// The order in which parts are drawn, so that few states change: indices of `parts`; equal ones stay in their order.
std::vector<uint32_t> order_by_part(std::span<const uint32_t> parts, const gpu_scene::GpuScene& scene);

/// Counts one more instance, of this number, to the last batch or a new one.
inline void add_to_batches(std::vector<CasterBatch>& batches, uint32_t part, uint32_t instance) {
    if (batches.empty() || batches.back().part != part) batches.push_back({part, instance, 0});
    ++batches.back().instance_count;
}

/// Draws from both sides. `shaders`: with casters.frag, MaskPush and kCasterTextures; buffers of vertices and
/// `instances`.
void record_casters(const graph::Recording& recording, const gpu::GraphicsPipelineCache& pipelines,
                    const gpu::GraphicsShaders& shaders, const gpu_scene::GpuScene& scene, graph::Resource instances,
                    const std::vector<CasterBatch>& batches);

}  // namespace vesper::render
