#include "gpu_scene/gpu_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <set>

#include "gpu_scene/formats.h"
#include "gpu_scene/intensity_tables.h"
#include "scene/reflectance.h"
#include "shaders/gbuffer/gbuffer.frag.inc"
#include "shaders/gbuffer/gbuffer.vert.inc"
#include "shared/gbuffer.h"
#include "shared/retro.h"
#include "shared/shade.h"

namespace vesper {
namespace {

VkVertexInputAttributeDescription attribute(uint32_t location, uint32_t binding, VkFormat format, size_t offset) {
    return {location, binding, format, uint32_t(offset)};
}

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

// What a road with a table reflects of light from all sides, and how much of that without sheen.
struct InDiffuse {
    float reflectance, plain;
};

std::vector<InDiffuse> in_diffuse(const Scene& scene) {
    std::vector<InDiffuse> roads;
    for (size_t i = 0; i < scene.reflection_tables.size(); ++i) {
        const ReflectionTable table = rendered_table(scene, i);
        roads.push_back({reflectance_in_diffuse(table), float(diffuse_luminance_coefficient(without_sheen(table)) /
                                                              diffuse_luminance_coefficient(table))});
    }
    return roads;
}

// A road with a table as the G-buffer holds it (shared/shade.h): the table says how much it reflects, the texture only
// and colours of vertices only where there is more and where less than in the mean of the surfaces that show it.
Material as_road(const Scene& scene, InDiffuse road, const MaterialUse& use, Material m) {
    const double mean = mean_reflectance(scene, m, use);
    const glm::vec3 colour = mean > 0 ? glm::vec3(glm::dvec3(m.base_colour) / mean) : glm::vec3(1);
    m.base_colour = glm::vec4(colour * road.reflectance, m.base_colour.a);
    m.metallic = shared::kRoadKind - float(m.reflection_table);
    m.roughness = -road.plain;
    m.metallic_roughness_texture = {};
    return m;
}

// A retroreflective surface as the G-buffer holds it (shared/retro.h).
Material as_sheet(Material m) {
    m.metallic = shared::kRetroCode + float(m.retroreflector);
    m.roughness = std::min(m.roughness, 0.999f);  // not matt: lamps count by what they give a surface facing them
    m.metallic_roughness_texture = {};
    return m;
}

// The largest stretch of a linear map is at most its Frobenius norm.
float largest_stretch(const glm::mat4& m) {
    const glm::mat3 linear(m);
    return std::sqrt(glm::dot(linear[0], linear[0]) + glm::dot(linear[1], linear[1]) + glm::dot(linear[2], linear[2]));
}

}  // namespace

Sphere sphere_of(const GpuScene::Part& part, const glm::mat4& m) {
    return {glm::vec3(m * glm::vec4(part.centre, 1)), part.radius * largest_stretch(m)};
}

OwnedBuffer upload_buffer(const Device& device, Arena& arena, std::span<const std::byte> bytes,
                          VkBufferUsageFlags usage) {
    OwnedBuffer buffer = make_buffer(device, bytes.size(), usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    arena.bind(buffer.get());
    const HostBuffer staging(device, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HostBuffer::Direction::ToDevice);
    std::memcpy(staging.data(), bytes.data(), bytes.size());
    staging.flush();
    device.run_once([&](VkCommandBuffer commands) {
        const VkBufferCopy region{.size = bytes.size()};
        vkCmdCopyBuffer(commands, staging.buffer(), buffer.get(), 1, &region);
    });
    return buffer;
}

GpuScene::GpuScene(const Device& device, const Scene& scene, PictureFormat pictures)
    : arena_(device), textures_(device, arena_, pictures), push_descriptors_(device.push_descriptors) {
    const VkDescriptorType sampled[3] = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                         VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                         VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
    set_ = make_set_layout(device, sampled, VK_SHADER_STAGE_FRAGMENT_BIT);
    layout_ = make_pipeline_layout(device, set_.get(), sizeof(shared::GBufferPush), VK_SHADER_STAGE_VERTEX_BIT);
    upload_geometry(device, scene);
    place(scene);
    make_surfaces(device, scene);
    make_pipelines(device);
}

void GpuScene::upload_geometry(const Device& device, const Scene& scene) {
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
    for (const Mesh& mesh : scene.meshes) {
        mesh_parts_.emplace_back(uint32_t(parts_.size()), uint32_t(mesh.primitives.size()));
        for (const Primitive& primitive : mesh.primitives) {
            const glm::vec3 centre =
                primitive.bounds.empty() ? glm::vec3(0) : (primitive.bounds.low + primitive.bounds.high) * 0.5f;
            const float radius = primitive.bounds.empty() ? 0 : glm::length(primitive.bounds.high - centre);
            parts_.push_back({primitive.material, uint32_t(indices.size()), uint32_t(primitive.indices.size()),
                              int32_t(vertices.size()), centre, radius});
            vertices.insert(vertices.end(), primitive.vertices.begin(), primitive.vertices.end());
            indices.insert(indices.end(), primitive.indices.begin(), primitive.indices.end());
        }
    }
    if (indices.empty()) return;
    vertices_ = upload_buffer(device, arena_, bytes_of(vertices), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    indices_ = upload_buffer(device, arena_, bytes_of(indices), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
}

void GpuScene::place(const Scene& scene) {
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].mesh == kNone) continue;
        const auto [first, count] = mesh_parts_[scene.nodes[i].mesh];
        placements_.push_back({i, first, count});
        for (uint32_t p = first; p < first + count; ++p) triangles_ += parts_[p].index_count / 3;
    }
}

void GpuScene::make_surfaces(const Device&, const Scene& scene) {
    const std::vector<InDiffuse> roads = in_diffuse(scene);
    const std::vector<MaterialUse> uses = roads.empty() ? std::vector<MaterialUse>{} : material_uses(scene);
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& stated = scene.materials[i];
        Material m = stated.reflection_table != kNone
                         ? as_road(scene, roads.at(stated.reflection_table), uses[i], stated)
                     : stated.retroreflector != kNone ? as_sheet(stated)
                                                      : stated;
        // Opacity passes through half floats, which may be half a step (2^-11 of the value) less than the code said.
        m.alpha_cutoff *= 1 - 0x1p-11f;
        uint32_t variant = 0;
        if (m.base_colour_texture.image != kNone) variant |= kBaseTexture;
        if (m.metallic_roughness_texture.image != kNone) variant |= kMetallicRoughnessTexture;
        const bool picture = m.emission_picture.image != kNone;
        if (m.emission != glm::vec3(0))
            variant |= picture || m.emission_texture.image != kNone ? kEmits | kEmissionTexture : kEmits;
        if (m.alpha == Material::Alpha::Mask) variant |= kMask;
        const bool masks = m.alpha == Material::Alpha::Mask && m.alpha_cutoff > 0 && m.base_colour.a > 0;
        const float cutoff = masks ? m.alpha_cutoff / m.base_colour.a : 0;  // of the texture
        float unit = 1;
        const VkDescriptorImageInfo emission = picture ? textures_.get_picture(scene, m.emission_picture, unit)
                                                       : textures_.get(scene, m.emission_texture, Decode::Srgb);
        m.emission *= unit;
        surfaces_.push_back({m,
                             variant,
                             {textures_.get(scene, m.base_colour_texture, Decode::Colour, cutoff),
                              textures_.get(scene, m.metallic_roughness_texture, Decode::Data), emission}});
    }
}

void GpuScene::make_pipelines(const Device& device) {
    std::set<uint32_t> variants;
    for (const Surface& surface : surfaces_) variants.insert(surface.variant);
    const OwnedShaderModule vertex = make_shader(device, gbuffer_vert), fragment = make_shader(device, gbuffer_frag);

    const VkVertexInputBindingDescription bindings[] = {{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX},
                                                        {1, sizeof(shared::Instance), VK_VERTEX_INPUT_RATE_INSTANCE}};
    const VkVertexInputAttributeDescription attributes[] = {
        attribute(0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)),
        attribute(1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)),
        attribute(2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, uv)),
        attribute(3, 0, VK_FORMAT_R16G16B16A16_UNORM, offsetof(Vertex, colour)),
        attribute(4, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row_x)),
        attribute(5, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row_y)),
        attribute(6, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row_z))};
    const VkPipelineVertexInputStateCreateInfo input{.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
                                                     .vertexBindingDescriptionCount = 2,
                                                     .pVertexBindingDescriptions = bindings,
                                                     .vertexAttributeDescriptionCount = 7,
                                                     .pVertexAttributeDescriptions = attributes};
    const VkPipelineInputAssemblyStateCreateInfo assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkPipelineViewportStateCreateInfo viewport{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
    const VkPipelineRasterizationStateCreateInfo raster{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .polygonMode = VK_POLYGON_MODE_FILL,
        .lineWidth = 1};
    const VkPipelineMultisampleStateCreateInfo samples{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp = VK_COMPARE_OP_GREATER};
    VkPipelineColorBlendAttachmentState blend[3];
    for (auto& b : blend) b = {.colorWriteMask = 0xf};
    const VkPipelineColorBlendStateCreateInfo blending{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO, .attachmentCount = 3, .pAttachments = blend};
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR, VK_DYNAMIC_STATE_CULL_MODE,
                                     VK_DYNAMIC_STATE_FRONT_FACE};
    const VkPipelineDynamicStateCreateInfo dynamic{.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                   .dynamicStateCount = 4,
                                                   .pDynamicStates = states};
    const VkFormat formats[] = {kReflectanceFormat, kSurfaceFormat, kEmissionFormat};
    const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                  .colorAttachmentCount = 3,
                                                  .pColorAttachmentFormats = formats,
                                                  .depthAttachmentFormat = kDepthFormat};
    for (const uint32_t variant : variants) {
        // Emission is cleared to 0; what emits is drawn after everything that could hide it.
        blend[2].colorWriteMask = (variant & kEmits) ? 0xf : 0;
        const uint32_t constants[4] = {variant & kBaseTexture, variant & kMetallicRoughnessTexture,
                                       variant & kEmissionTexture, variant & kMask};
        const VkSpecializationMapEntry entries[4] = {{0, 0, 4}, {1, 4, 4}, {2, 8, 4}, {3, 12, 4}};
        const VkSpecializationInfo specialization{4, entries, sizeof constants, constants};
        const VkPipelineShaderStageCreateInfo stages[] = {{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                           .stage = VK_SHADER_STAGE_VERTEX_BIT,
                                                           .module = vertex.get(),
                                                           .pName = "main"},
                                                          {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                           .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
                                                           .module = fragment.get(),
                                                           .pName = "main",
                                                           .pSpecializationInfo = &specialization}};
        const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                                .pNext = &rendering,
                                                .stageCount = 2,
                                                .pStages = stages,
                                                .pVertexInputState = &input,
                                                .pInputAssemblyState = &assembly,
                                                .pViewportState = &viewport,
                                                .pRasterizationState = &raster,
                                                .pMultisampleState = &samples,
                                                .pDepthStencilState = &depth,
                                                .pColorBlendState = &blending,
                                                .pDynamicState = &dynamic,
                                                .layout = layout_.get()};
        VkPipeline pipeline = VK_NULL_HANDLE;
        const PipelineTimer timer(device);
        check(vkCreateGraphicsPipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
              "compiling the G-buffer");
        pipelines_[variant] = {device.handle(), pipeline};
    }
}

float GpuScene::farthest_depth(const SceneFrame& frame, const View& view) const {
    float farthest = 0;
    for (const Placement& placement : placements_) {
        const glm::mat4 m = view.from(frame.world[placement.node]);
        for (uint32_t i = placement.first_part; i < placement.first_part + placement.part_count; ++i) {
            const Sphere sphere = sphere_of(parts_[i], m);
            farthest = std::max(farthest, sphere.radius - sphere.centre.z);
        }
    }
    return farthest;
}

}  // namespace vesper
