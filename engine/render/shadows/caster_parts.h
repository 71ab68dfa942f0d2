// Parts of a scene that cast shadows, and what they are drawn with. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "render/frame_context.h"

namespace vesper::render {

constexpr uint32_t kMostGroups = 65535;  ///< workgroups of a dispatch along an axis, which any device has

/// A buffer for so many texels of shadow maps, halves, two a word; at least one word. Bound in `arena`.
gpu::OwnedBuffer make_shadow_texels(const gpu::Device& device, gpu::Arena& arena, uint64_t texels);

/// Buffers with which shadow maps of lamps are drawn; reserved in every frame that has maps, drawn or not.
struct ShadowMapScratch {
    graph::Resource vertices, indices;  ///< of the scene, as texels
    graph::Resource lamps;              ///< maps of the lamps of the frame: those that keep none are not drawn; or none
    graph::Resource changed;  ///< tiles that are listed as changed, see shared::ChangedTile; a word where none is
    graph::Resource draws;    ///< VkDrawIndirectCommand
    graph::Resource large;    ///< shared::LargeCorner, of kMostTriangles
    graph::Resource drawn;    ///< texels of hemispheres as they are drawn, floats, `texels`
    uint32_t texels = 0;      ///< of hemispheres that are drawn at once: at least of the largest

    static constexpr uint32_t kMostTriangles = 1u << 18u;  ///< of a dispatch
    static constexpr uint32_t kMostTexels = 1u << 22u;     ///< of the largest that there is
    /// Of a scratch for maps that take so many texels together.
    static uint64_t bytes(uint64_t texels);
};
/// `changed`: for maps over which something is drawn. `texels`: that all maps take together, or more.
ShadowMapScratch add_shadow_map_scratch(const FrameContext& frame, const gpu_scene::GpuScene& scene,
                                        graph::Resource changed = {}, uint64_t texels = ShadowMapScratch::kMostTexels);

/// Of clipmap.frag and masked_casters.frag: the opacity of a masked material.
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

/// Draws from both sides. `shaders`: of MaskPush, with `others` at the first bindings and then a texture; buffers of
/// vertices and `instances`. `variant`: of their pipelines; constant 0 is whether a material is masked.
void record_casters(const graph::Recording& recording, const gpu::GraphicsPipelineCache& pipelines,
                    const gpu::GraphicsShaders& shaders, gpu::GraphicsVariant variant, const gpu_scene::GpuScene& scene,
                    graph::Resource instances, const std::vector<CasterBatch>& batches,
                    std::span<const VkWriteDescriptorSet> others = {});

}  // namespace vesper::render
