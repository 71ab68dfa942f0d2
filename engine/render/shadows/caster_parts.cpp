#include "render/shadows/caster_parts.h"

#include <algorithm>
#include <tuple>

#include "render/shadows/shadow_map_layout.h"
#include "scene/scene.h"
#include "shared/shadow_map.h"

namespace vesper::render {
namespace {

constexpr uint64_t kLargeBytes = uint64_t{ShadowMapScratch::kMostTriangles} * 3 * sizeof(shared::LargeCorner);

}  // namespace

gpu::OwnedBuffer make_shadow_texels(const gpu::Device& device, gpu::Arena& arena, uint64_t texels) {
    gpu::OwnedBuffer buffer =
        gpu::make_buffer(device, std::max<uint64_t>(texels / 2, 1) * sizeof(uint32_t),
                         gpu::kTexelUsage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    arena.bind(buffer.get());
    return buffer;
}

uint64_t ShadowMapScratch::bytes(uint64_t texels) {
    return sizeof(VkDrawIndirectCommand) + kLargeBytes + std::min<uint64_t>(texels, kMostTexels) * sizeof(float);
}

ShadowMapScratch add_shadow_map_scratch(const FrameContext& frame, const gpu_scene::GpuScene& scene,
                                        graph::Resource changed, uint64_t texels) {
    using graph::Access;
    graph::FrameGraph& graph = frame.graph;
    ShadowMapScratch scratch;
    scratch.changed = changed;
    scratch.texels = uint32_t(std::min<uint64_t>(texels, ShadowMapScratch::kMostTexels));
    if (!changed) {
        scratch.changed = graph.transient("no changed tiles", graph::buffer_shape(sizeof(uint32_t)));
        graph.clear("clear no changed tiles", scratch.changed);
    }
    scratch.draws = graph.reserved("shadow draws", graph::buffer_shape(sizeof(VkDrawIndirectCommand)),
                                   {Access::CopyPart, Access::CopyTarget, Access::Update, Access::Arguments});
    scratch.large =
        graph.reserved("large shadow casters", graph::buffer_shape(kLargeBytes), {Access::Store, Access::Vertices});
    scratch.drawn = graph.reserved("drawn shadow maps", graph::buffer_shape(uint64_t{scratch.texels} * sizeof(float)),
                                   {Access::CopyPart, Access::Update, Access::Load});
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
                    const gpu::GraphicsShaders& shaders, gpu::GraphicsVariant variant, const gpu_scene::GpuScene& scene,
                    graph::Resource instances, const std::vector<CasterBatch>& batches,
                    std::span<const VkWriteDescriptorSet> others) {
    if (batches.empty()) return;
    const VkCommandBuffer commands = recording.commands();
    const VkBuffer buffers[] = {scene.vertices().get(), recording.buffer(instances)};
    const VkDeviceSize offsets[] = {0, recording.offset(instances)};
    vkCmdBindVertexBuffers(commands, 0, 2, buffers, offsets);
    vkCmdBindIndexBuffer(commands, scene.indices().get(), 0, VK_INDEX_TYPE_UINT32);
    vkCmdSetCullMode(commands, VK_CULL_MODE_NONE);
    vkCmdSetFrontFace(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    std::vector<VkWriteDescriptorSet> writes(others.begin(), others.end());
    writes.push_back({.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                      .dstBinding = uint32_t(others.size()),
                      .descriptorCount = 1,
                      .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER});
    uint32_t last_material = scene::kNone;
    const gpu::GraphicsPipeline* last_pipeline = nullptr;
    for (const CasterBatch& batch : batches) {
        const gpu_scene::GpuScene::Part& part = scene.parts()[batch.part];
        const gpu_scene::GpuScene::Surface& surface = scene.surfaces()[part.material];
        const scene::Material& m = surface.material;
        const bool mask = m.alpha == scene::Material::Alpha::Mask;
        variant.constants[0] = mask ? 1 : 0;
        const gpu::GraphicsPipeline* pipeline = &pipelines.get(shaders, variant);
        if (pipeline != last_pipeline)
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->pipeline());
        if (part.material != last_material) {
            writes.back().pImageInfo = &surface.textures[0];
            recording.bind(*pipeline, writes);
            const MaskPush push{m.base_colour.a, m.alpha_cutoff};
            vkCmdPushConstants(commands, pipeline->layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push, &push);
        }
        vkCmdDrawIndexed(commands, part.index_count, batch.instance_count, part.first_index, part.first_vertex,
                         batch.first_instance);
        last_material = part.material, last_pipeline = pipeline;
    }
}

}  // namespace vesper::render
