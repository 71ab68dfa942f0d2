// Parts of a scene, drawn into maps of distances from lamps. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <tuple>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "render/frame_context.h"

namespace vesper::render {

/// A buffer for so many texels of maps, halves, two a word; at least one word. Bound in `arena`.
gpu::OwnedBuffer make_map_texels(const gpu::Device& device, gpu::Arena& arena, uint64_t texels);

/// Of distance_map.frag: what a masked material lets through.
struct MaskPush {
    float base_opacity, cutoff;
};
inline constexpr VkDescriptorType kMapTextures[]{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};

/// Instances of one part, drawn at once.
struct MapBatch {
    uint32_t part;
    uint32_t first_instance, instance_count;
};

/// Sorts what is drawn, so that few states change. `part_of`: a value's part.
template <class T, class PartOf>
void sort_by_part(std::vector<T>& drawn, const gpu_scene::GpuScene& scene, PartOf part_of) {
    std::ranges::stable_sort(drawn, {}, [&](const T& d) {
        const uint32_t part = part_of(d), material = scene.parts()[part].material;
        return std::tuple(scene.surfaces()[material].material.alpha, material, part);
    });
}

/// Counts one more instance, of this number, to the last batch or a new one.
inline void add_to_batches(std::vector<MapBatch>& batches, uint32_t part, uint32_t instance) {
    if (batches.empty() || batches.back().part != part) batches.push_back({part, instance, 0});
    ++batches.back().instance_count;
}

/// Draws from both sides. `shaders`: with distance_map.frag, MaskPush and kMapTextures; buffers of vertices and
/// `instances`.
void record_map_parts(const graph::Recording& recording, const gpu::Device& device,
                      const gpu::GraphicsPipelineCache& pipelines, const gpu::GraphicsShaders& shaders,
                      const gpu_scene::GpuScene& scene, graph::Resource instances,
                      const std::vector<MapBatch>& batches);

}  // namespace vesper::render
