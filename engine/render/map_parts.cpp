#include "render/map_parts.h"

#include <algorithm>
#include <tuple>

namespace vesper::render {

gpu::OwnedBuffer make_map_texels(const gpu::Device& device, gpu::Arena& arena, uint64_t texels) {
    gpu::OwnedBuffer buffer =
        gpu::make_buffer(device, std::max<uint64_t>(texels / 2, 1) * sizeof(uint32_t),
                         gpu_scene::kTexelUsage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    arena.bind(buffer.get());
    return buffer;
}

std::vector<uint32_t> order_by_part(std::span<const uint32_t> parts, const gpu_scene::GpuScene& scene) {
    std::vector<std::tuple<scene::Material::Alpha, uint32_t, uint32_t, uint32_t>> keys;
    keys.reserve(parts.size());
    for (const uint32_t part : parts) {
        const uint32_t material = scene.parts()[part].material;
        keys.emplace_back(scene.surfaces()[material].material.alpha, material, part, uint32_t(keys.size()));
    }
    std::ranges::sort(keys);
    std::vector<uint32_t> order;
    order.reserve(keys.size());
    for (const auto& [alpha, material, part, index] : keys) order.push_back(index);
    return order;
}

void record_map_parts(const graph::Recording& recording, const gpu::GraphicsPipelineCache& pipelines,
                      const gpu::GraphicsShaders& shaders, const gpu_scene::GpuScene& scene, graph::Resource instances,
                      const std::vector<MapBatch>& batches) {
    if (batches.empty()) return;
    const VkCommandBuffer commands = recording.commands();
    const VkBuffer buffers[] = {scene.vertices(), recording.buffer(instances)};
    const VkDeviceSize offsets[] = {0, recording.offset(instances)};
    vkCmdBindVertexBuffers(commands, 0, 2, buffers, offsets);
    vkCmdBindIndexBuffer(commands, scene.indices(), 0, VK_INDEX_TYPE_UINT32);
    vkCmdSetCullMode(commands, VK_CULL_MODE_NONE);
    vkCmdSetFrontFace(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    uint32_t last_material = scene::kNone;
    const gpu::GraphicsPipeline* last_pipeline = nullptr;
    for (const MapBatch& batch : batches) {
        const gpu_scene::GpuScene::Part& part = scene.parts()[batch.part];
        const gpu_scene::GpuScene::Surface& surface = scene.surfaces()[part.material];
        const scene::Material& m = surface.material;
        const bool mask = m.alpha == scene::Material::Alpha::Mask;
        const gpu::GraphicsPipeline* pipeline =
            &pipelines.get(shaders, {.targets = {}, .depth = kDepthFormat, .constants = {mask ? 1u : 0u}});
        if (pipeline != last_pipeline)
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->pipeline());
        if (part.material != last_material) {
            VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                       .dstBinding = 0,
                                       .descriptorCount = 1,
                                       .descriptorType = kMapTextures[0],
                                       .pImageInfo = &surface.textures[0]};
            recording.bind(*pipeline, {&write, 1});
            const MaskPush push{m.base_colour.a, m.alpha_cutoff};
            vkCmdPushConstants(commands, pipeline->layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push, &push);
        }
        vkCmdDrawIndexed(commands, part.index_count, batch.instance_count, part.first_index, part.first_vertex,
                         batch.first_instance);
        last_material = part.material, last_pipeline = pipeline;
    }
}

}  // namespace vesper::render
