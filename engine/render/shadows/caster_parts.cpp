#include "render/shadows/caster_parts.h"

#include <algorithm>
#include <string>
#include <tuple>

#include "base/error.h"
#include "render/shadows/shadow_map_layout.h"
#include "scene/scene.h"

namespace vesper::render {

gpu::OwnedBuffer make_shadow_texels(const gpu::Device& device, gpu::Arena& arena, uint64_t texels) {
    gpu::OwnedBuffer buffer =
        gpu::make_buffer(device, std::max<uint64_t>(texels / 2, 1) * sizeof(uint32_t),
                         gpu::kTexelUsage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    arena.bind(buffer.get());
    return buffer;
}

const ShadowMapScratch::Image& ShadowMapScratch::image_for(uint32_t side) const {
    for (const Image& image : images)
        if (side <= image.side) return image;
    throw Error("a map of " + std::to_string(side) + " texels a side is too large");
}

ShadowMapScratch add_shadow_map_scratch(const FrameContext& frame, const gpu_scene::GpuScene& scene) {
    using graph::Access;
    graph::FrameGraph& graph = frame.graph;
    ShadowMapScratch scratch;
    uint32_t side = kMostMapSide / 2;
    for (ShadowMapScratch::Image& image : scratch.images) {
        const std::string which = " of " + std::to_string(side);
        const uint64_t texels = uint64_t{side} * side;
        image = {side,
                 graph.reserved("drawn shadow maps" + which, graph::image_shape(kDepthFormat, {side, side}),
                                {Access::DepthTarget, Access::Sample}),
                 graph.reserved("small shadow casters" + which, graph::buffer_shape(texels * sizeof(float)),
                                {Access::CopyTarget, Access::Update, Access::Load})};
        side *= 2;
    }
    scratch.draws = graph.reserved(
        "shadow draws", graph::buffer_shape(ShadowMapScratch::kMostQuadrants * sizeof(VkDrawIndirectCommand)),
        {Access::CopyPart, Access::Update, Access::Arguments});
    scratch.triangles = graph.reserved(
        "shadow triangles", graph::buffer_shape(uint64_t{ShadowMapScratch::kMostTriangles} * 3 * sizeof(glm::vec3)),
        {Access::Store, Access::Vertices});
    if (scene.caster_vertex_count() > 0) {
        scratch.vertices = graph.external("vertices of casters", scene.vertices(),
                                          scene.caster_vertex_count() * sizeof(scene::Vertex), VK_FORMAT_R32G32_SFLOAT);
        scratch.indices = graph.external("indices of casters", scene.indices(), scene.index_count() * sizeof(uint32_t),
                                         VK_FORMAT_R32_UINT);
    }
    return scratch;
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

void record_casters(const graph::Recording& recording, const gpu::GraphicsPipelineCache& pipelines,
                    const gpu::GraphicsShaders& shaders, const gpu_scene::GpuScene& scene, graph::Resource instances,
                    const std::vector<CasterBatch>& batches) {
    if (batches.empty()) return;
    const VkCommandBuffer commands = recording.commands();
    const VkBuffer buffers[] = {scene.vertices().get(), recording.buffer(instances)};
    const VkDeviceSize offsets[] = {0, recording.offset(instances)};
    vkCmdBindVertexBuffers(commands, 0, 2, buffers, offsets);
    vkCmdBindIndexBuffer(commands, scene.indices().get(), 0, VK_INDEX_TYPE_UINT32);
    vkCmdSetCullMode(commands, VK_CULL_MODE_NONE);
    vkCmdSetFrontFace(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    uint32_t last_material = scene::kNone;
    const gpu::GraphicsPipeline* last_pipeline = nullptr;
    for (const CasterBatch& batch : batches) {
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
                                       .descriptorType = kCasterTextures[0],
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
