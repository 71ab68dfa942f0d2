#include "gpu/graphics_pipeline.h"

#include <iterator>
#include <string>

namespace vesper::gpu {
namespace {

OwnedPipeline make_pipeline(const Device& device, const GraphicsShaders& shaders, const GraphicsVariant& variant,
                            VkPipelineLayout layout) {
    const OwnedShaderModule vertex = make_shader(device, shaders.vertex),
                            fragment = make_shader(device, shaders.fragment);
    const Specialization constants(variant.constants);
    const VkPipelineShaderStageCreateInfo stages[] = {{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                       .stage = VK_SHADER_STAGE_VERTEX_BIT,
                                                       .module = vertex.get(),
                                                       .pName = "main"},
                                                      {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                       .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
                                                       .module = fragment.get(),
                                                       .pName = "main",
                                                       .pSpecializationInfo = constants.info()}};
    const VkPipelineVertexInputStateCreateInfo input{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = uint32_t(shaders.buffers.size()),
        .pVertexBindingDescriptions = shaders.buffers.data(),
        .vertexAttributeDescriptionCount = uint32_t(shaders.attributes.size()),
        .pVertexAttributeDescriptions = shaders.attributes.data()};
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
    const bool has_depth = variant.depth != VK_FORMAT_UNDEFINED;
    const VkPipelineDepthStencilStateCreateInfo depth{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = has_depth,
        .depthWriteEnable = has_depth,
        .depthCompareOp = VK_COMPARE_OP_GREATER};
    std::vector<VkFormat> formats;
    std::vector<VkPipelineColorBlendAttachmentState> blend;
    for (const ColourTarget& target : variant.targets) {
        formats.push_back(target.format);
        blend.push_back({.blendEnable = target.blended,
                         .srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA,
                         .dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
                         .srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO,
                         .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
                         .colorWriteMask = target.written ? 0xfu : 0u});
    }
    const VkPipelineColorBlendStateCreateInfo blending{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = uint32_t(blend.size()),
        .pAttachments = blend.data()};
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR, VK_DYNAMIC_STATE_CULL_MODE,
                                     VK_DYNAMIC_STATE_FRONT_FACE};
    const VkPipelineDynamicStateCreateInfo dynamic{.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                   .dynamicStateCount = uint32_t(std::size(states)),
                                                   .pDynamicStates = states};
    const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                  .colorAttachmentCount = uint32_t(formats.size()),
                                                  .pColorAttachmentFormats = formats.data(),
                                                  .depthAttachmentFormat = variant.depth};
    const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                            .pNext = &rendering,
                                            .stageCount = uint32_t(std::size(stages)),
                                            .pStages = stages,
                                            .pVertexInputState = &input,
                                            .pInputAssemblyState = &assembly,
                                            .pViewportState = &viewport,
                                            .pRasterizationState = &raster,
                                            .pMultisampleState = &samples,
                                            .pDepthStencilState = &depth,
                                            .pColorBlendState = &blending,
                                            .pDynamicState = &dynamic,
                                            .layout = layout};
    VkPipeline pipeline = VK_NULL_HANDLE;
    const PipelineTimer timer(device);
    check(vkCreateGraphicsPipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
          "compiling " + std::string(shaders.name));
    return {device.handle(), pipeline};
}

}  // namespace

GraphicsPipeline::GraphicsPipeline(const Device& device, const GraphicsShaders& shaders, const GraphicsVariant& variant)
    : set_(make_set_layout(device, shaders.bindings, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT)),
      layout_(make_pipeline_layout(device, set_.get(), shaders.push_bytes, shaders.push_stages)),
      pipeline_(make_pipeline(device, shaders, variant, layout_.get())) {}

const GraphicsPipeline& GraphicsPipelineCache::get(const GraphicsShaders& shaders,
                                                   const GraphicsVariant& variant) const {
    const std::span<const uint32_t> vertex = shaders.vertex, fragment = shaders.fragment;
    Key key{vertex.data(), fragment.data(), variant};
    const auto found = pipelines_.find(key);
    if (found != pipelines_.end()) return found->second;
    return pipelines_.emplace(std::move(key), GraphicsPipeline(device_, shaders, variant)).first->second;
}

}  // namespace vesper::gpu
