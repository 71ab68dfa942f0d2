#include "window/presenter.h"

#include <algorithm>
#include <cstring>

#include "shaders/window/overlay.frag.inc"
#include "shaders/window/overlay.vert.inc"
#include "shaders/window/present.frag.inc"
#include "shaders/window/present.vert.inc"
#include "shared/present.h"

namespace vesper {
namespace {

constexpr VkFormat kCoverageFormat = VK_FORMAT_R8_UNORM;
constexpr VkShaderStageFlags kPushStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

OwnedPipeline make_pipeline(const Device& device, VkPipelineLayout layout, std::span<const uint32_t> vertex_spirv,
                            std::span<const uint32_t> fragment_spirv, const VkPipelineVertexInputStateCreateInfo& input,
                            bool blended, VkFormat format) {
    const OwnedShaderModule vertex = make_shader(device, vertex_spirv), fragment = make_shader(device, fragment_spirv);
    const VkPipelineShaderStageCreateInfo stages[] = {{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                       .stage = VK_SHADER_STAGE_VERTEX_BIT,
                                                       .module = vertex.get(),
                                                       .pName = "main"},
                                                      {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                       .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
                                                       .module = fragment.get(),
                                                       .pName = "main"}};
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
    const VkPipelineColorBlendAttachmentState blend{.blendEnable = blended,
                                                    .srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA,
                                                    .dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
                                                    .srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO,
                                                    .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
                                                    .colorWriteMask = 0xf};
    const VkPipelineColorBlendStateCreateInfo blending{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &blend};
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineDynamicStateCreateInfo dynamic{.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                   .dynamicStateCount = 2,
                                                   .pDynamicStates = states};
    const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                  .colorAttachmentCount = 1,
                                                  .pColorAttachmentFormats = &format};
    const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                            .pNext = &rendering,
                                            .stageCount = 2,
                                            .pStages = stages,
                                            .pVertexInputState = &input,
                                            .pInputAssemblyState = &assembly,
                                            .pViewportState = &viewport,
                                            .pRasterizationState = &raster,
                                            .pMultisampleState = &samples,
                                            .pColorBlendState = &blending,
                                            .pDynamicState = &dynamic,
                                            .layout = layout};
    VkPipeline pipeline = VK_NULL_HANDLE;
    const PipelineTimer timer(device);
    check(vkCreateGraphicsPipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
          "compiling what draws a window");
    return {device.handle(), pipeline};
}

OwnedSetLayout one_binding(const Device& device, VkDescriptorType type) {
    return make_set_layout(device, std::array{type}, VK_SHADER_STAGE_FRAGMENT_BIT);
}

/// Room for so many bytes, kept where there is enough.
void reserve(const Device& device, HostBuffer& buffer, uint64_t bytes, VkBufferUsageFlags usage) {
    if (buffer.bytes() < bytes) buffer = HostBuffer(device, bytes * 3 / 2, usage, HostBuffer::Direction::ToDevice);
}

}  // namespace

Placement place(VkExtent2D picture, VkExtent2D window, Scaling scaling) {
    const uint32_t times = std::min(window.width / picture.width, window.height / picture.height);
    VkExtent2D size{picture.width * times, picture.height * times};
    const bool whole =
        times >= 1 && (scaling == Scaling::Whole || size.width == window.width || size.height == window.height);
    if (!whole) {
        // Rounded to the nearest pixel, and never to none.
        const auto share = [](uint64_t of, uint64_t by, uint64_t over) {
            return uint32_t(std::max<uint64_t>((of * by + over / 2) / over, 1));
        };
        if (uint64_t(picture.width) * window.height >= uint64_t(window.width) * picture.height)
            size = {window.width, share(picture.height, window.width, picture.width)};
        else
            size = {share(picture.width, window.height, picture.height), window.height};
    }
    return {{{int32_t((window.width - size.width) / 2), int32_t((window.height - size.height) / 2)}, size},
            whole ? times : 0};
}

Presenter::Presenter(Device& device, VkExtent2D coverage_extent, std::span<const uint8_t> coverage)
    : device_(device),
      picture_set_(one_binding(device, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER)),
      overlay_set_(one_binding(device, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER)),
      picture_layout_(
          make_pipeline_layout(device, picture_set_.get(), sizeof(shared::PresentPush), VK_SHADER_STAGE_FRAGMENT_BIT)),
      overlay_layout_(make_pipeline_layout(device, overlay_set_.get(), sizeof(shared::OverlayPush), kPushStages)),
      arena_(device) {
    upload_coverage(coverage_extent, coverage);
    const VkSamplerCreateInfo sampler{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                      .magFilter = VK_FILTER_LINEAR,
                                      .minFilter = VK_FILTER_LINEAR,
                                      .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                      .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
    VkSampler raw = VK_NULL_HANDLE;
    check(vkCreateSampler(device.handle(), &sampler, nullptr, &raw), "making a sampler");
    sampler_ = {device.handle(), raw};
}

Presenter::~Presenter() { vkQueueWaitIdle(device_.queue()); }

void Presenter::upload_coverage(VkExtent2D extent, std::span<const uint8_t> coverage) {
    if (coverage.size() != size_t(extent.width) * extent.height)
        throw Error("letters of an overlay: not a byte a texel");
    coverage_ = make_image(
        device_, image_info(kCoverageFormat, extent, 1, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT));
    arena_.bind(coverage_.get());
    coverage_view_ = make_view(device_, coverage_.get(), kCoverageFormat);
    const HostBuffer staging(device_, coverage.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                             HostBuffer::Direction::ToDevice);
    std::memcpy(staging.data(), coverage.data(), coverage.size());
    staging.flush();
    device_.run_once([&](VkCommandBuffer commands) {
        const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                     .imageExtent = {extent.width, extent.height, 1}};
        record_upload(commands, staging.buffer(), coverage_.get(), {&copy, 1});
    });
}

const Presenter::Pipelines& Presenter::pipelines(VkFormat format) {
    const auto found = pipelines_.find(format);
    if (found != pipelines_.end()) return found->second;
    const VkPipelineVertexInputStateCreateInfo none{.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkVertexInputBindingDescription binding{0, sizeof(Overlay::Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
    const VkVertexInputAttributeDescription attributes[] = {
        {0, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Overlay::Vertex, position)},
        {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Overlay::Vertex, uv)},
        {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(Overlay::Vertex, colour)}};
    const VkPipelineVertexInputStateCreateInfo vertices{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = 1,
        .pVertexBindingDescriptions = &binding,
        .vertexAttributeDescriptionCount = 3,
        .pVertexAttributeDescriptions = attributes};
    return pipelines_
        .emplace(format,
                 Pipelines{
                     make_pipeline(device_, picture_layout_.get(), present_vert, present_frag, none, false, format),
                     make_pipeline(device_, overlay_layout_.get(), overlay_vert, overlay_frag, vertices, true, format)})
        .first->second;
}

void Presenter::draw(VkCommandBuffer commands, const WindowImage& image, const Picture& picture, Scaling scaling,
                     const Overlay& overlay) {
    const VkRenderingAttachmentInfo target{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                           .imageView = image.view,
                                           .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                           .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                           .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                           .clearValue = {.color = {.float32 = {0, 0, 0, 1}}}};
    const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                               .renderArea = {{0, 0}, image.extent},
                               .layerCount = 1,
                               .colorAttachmentCount = 1,
                               .pColorAttachments = &target};
    vkCmdBeginRendering(commands, &info);
    Slot& slot = slots_[image.slot];
    if (!picture.codes.empty()) draw_picture(commands, image, picture, scaling, slot);
    if (!overlay.batches.empty()) draw_overlay(commands, image, overlay, slot);
    vkCmdEndRendering(commands);
}

void Presenter::draw_picture(VkCommandBuffer commands, const WindowImage& image, const Picture& picture,
                             Scaling scaling, Slot& slot) {
    const uint64_t pixels = uint64_t(picture.extent.width) * picture.extent.height;
    if (picture.codes.size() != pixels * 4) throw Error("a picture for a window: not four bytes a pixel");
    if (pixels > device_.limits().maxTexelBufferElements)
        throw Error("a picture of " + std::to_string(picture.extent.width) + "x" +
                    std::to_string(picture.extent.height) + " is too large to be shown by " + device_.name());
    if (slot.words.bytes() != pixels * 4) {
        slot.texels = {};
        slot.words =
            HostBuffer(device_, pixels * 4, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, HostBuffer::Direction::ToDevice);
        const VkBufferViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                          .buffer = slot.words.buffer(),
                                          .format = VK_FORMAT_R32_UINT,
                                          .range = VK_WHOLE_SIZE};
        VkBufferView view = VK_NULL_HANDLE;
        check(vkCreateBufferView(device_.handle(), &info, nullptr, &view), "viewing a picture");
        slot.texels = {device_.handle(), view};
    }
    std::memcpy(slot.words.data(), picture.codes.data(), picture.codes.size());
    slot.words.flush();

    const Placement at = place(picture.extent, image.extent, scaling);
    const shared::PresentPush push{.size = {picture.extent.width, picture.extent.height},
                                   .origin = {at.area.offset.x, at.area.offset.y},
                                   .step = {float(picture.extent.width) / float(at.area.extent.width),
                                            float(picture.extent.height) / float(at.area.extent.height)},
                                   .bits = picture.bits,
                                   .filtered = at.times == 0};
    const VkViewport viewport{float(at.area.offset.x),
                              float(at.area.offset.y),
                              float(at.area.extent.width),
                              float(at.area.extent.height),
                              0,
                              1};
    const VkBufferView view = slot.texels.get();
    const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     .descriptorCount = 1,
                                     .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                                     .pTexelBufferView = &view};
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines(image.format).picture.get());
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &at.area);
    device_.push_descriptors(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, picture_layout_.get(), 0, 1, &write);
    vkCmdPushConstants(commands, picture_layout_.get(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push, &push);
    vkCmdDraw(commands, 3, 1, 0, 0);
}

void Presenter::draw_overlay(VkCommandBuffer commands, const WindowImage& image, const Overlay& overlay, Slot& slot) {
    const auto vertices = std::as_bytes(std::span(overlay.vertices)),
               indices = std::as_bytes(std::span(overlay.indices));
    reserve(device_, slot.vertices, vertices.size(), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    reserve(device_, slot.indices, indices.size(), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    std::memcpy(slot.vertices.data(), vertices.data(), vertices.size());
    std::memcpy(slot.indices.data(), indices.data(), indices.size());
    slot.vertices.flush(), slot.indices.flush();

    const shared::OverlayPush push{.scale = {2.0f / float(image.extent.width), 2.0f / float(image.extent.height)},
                                   .white = kOverlayWhite,
                                   .hdr10 = image.hdr10};
    const VkViewport viewport{0, 0, float(image.extent.width), float(image.extent.height), 0, 1};
    const VkDescriptorImageInfo letters{sampler_.get(), coverage_view_.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     .descriptorCount = 1,
                                     .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                     .pImageInfo = &letters};
    const VkBuffer buffer = slot.vertices.buffer();
    const VkDeviceSize offset = 0;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines(image.format).overlay.get());
    vkCmdSetViewport(commands, 0, 1, &viewport);
    device_.push_descriptors(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, overlay_layout_.get(), 0, 1, &write);
    vkCmdPushConstants(commands, overlay_layout_.get(), kPushStages, 0, sizeof push, &push);
    vkCmdBindVertexBuffers(commands, 0, 1, &buffer, &offset);
    vkCmdBindIndexBuffer(commands, slot.indices.buffer(), 0, VK_INDEX_TYPE_UINT32);
    for (const Overlay::Batch& batch : overlay.batches) {
        // The window may have become smaller since the batch was made.
        const auto [at, size] = batch.clip;
        const VkExtent2D whole = image.extent;
        if (uint32_t(at.x) >= whole.width || uint32_t(at.y) >= whole.height) continue;
        const VkRect2D clip{
            at,
            {std::min(size.width, whole.width - uint32_t(at.x)), std::min(size.height, whole.height - uint32_t(at.y))}};
        vkCmdSetScissor(commands, 0, 1, &clip);
        vkCmdDrawIndexed(commands, batch.indices, 1, batch.first_index, 0, 0);
    }
}

}  // namespace vesper
