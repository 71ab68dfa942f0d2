#include "window/presenter.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "shaders/window/overlay.frag.inc"
#include "shaders/window/overlay.vert.inc"
#include "shaders/window/present.frag.inc"
#include "shaders/window/present.vert.inc"
#include "shaders/window/present_image.frag.inc"
#include "shared/present.h"

namespace vesper::window {
namespace {

constexpr VkFormat kCoverageFormat = VK_FORMAT_R8_UNORM;
constexpr VkShaderStageFlags kPushStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

constexpr VkDescriptorType kTexels[]{VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER},
    kStorage[]{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, kLetters[]{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
constexpr gpu::GraphicsShaders kPicture{
    "present.frag", present_vert, present_frag, kTexels, sizeof(shared::PresentPush), VK_SHADER_STAGE_FRAGMENT_BIT};
constexpr gpu::GraphicsShaders kPictureOfStorage{"present.frag",
                                                 present_vert,
                                                 present_frag_storage,
                                                 kStorage,
                                                 sizeof(shared::PresentPush),
                                                 VK_SHADER_STAGE_FRAGMENT_BIT};

constexpr gpu::GraphicsShaders kPictureOfImage{"present_image.frag",        present_vert,
                                               present_image_frag,          kLetters,
                                               sizeof(shared::PresentPush), VK_SHADER_STAGE_FRAGMENT_BIT};

constexpr VkVertexInputBindingDescription kVertices[]{{0, sizeof(Overlay::Vertex), VK_VERTEX_INPUT_RATE_VERTEX}};
constexpr VkVertexInputAttributeDescription kAttributes[]{
    {0, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Overlay::Vertex, position)},
    {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Overlay::Vertex, uv)},
    {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(Overlay::Vertex, colour)}};
constexpr gpu::GraphicsShaders kOverlay{
    "overlay.frag", overlay_vert, overlay_frag, kLetters, sizeof(shared::OverlayPush),
    kPushStages,    kVertices,    kAttributes};

/// Room for so many bytes, kept where there is enough.
void reserve(const gpu::Device& device, gpu::HostBuffer& buffer, uint64_t bytes, VkBufferUsageFlags usage) {
    if (buffer.bytes() < bytes)
        buffer = gpu::HostBuffer(device, bytes * 3 / 2, usage, gpu::HostBuffer::Direction::ToDevice);
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

graph::ExternalImage PictureImage::target(VkExtent2D extent, uint32_t bits) {
    const VkFormat format = bits == 8 ? VK_FORMAT_R8G8B8A8_UNORM : VK_FORMAT_A2B10G10R10_UNORM_PACK32;
    if (extent.width != extent_.width || extent.height != extent_.height || bits != bits_) {
        gpu::check(vkQueueWaitIdle(device_.queue()), "waiting for the device");
        extent_ = {0, 0}, view_ = {}, image_ = {};
        arena_.emplace(device_);
        image_ = gpu::make_image(
            device_, gpu::image_info(format, extent, 1, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT));
        arena_->bind(image_.get());
        view_ = gpu::make_view(device_, image_.get(), format);
        extent_ = extent, bits_ = bits;
    }
    return {.image = image_.get(),
            .format = format,
            .extent = extent,
            .before = VK_IMAGE_LAYOUT_UNDEFINED,
            .after = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

Presenter::Presenter(gpu::Device& device, VkExtent2D coverage_extent, std::span<const uint8_t> coverage)
    : device_(device), pipelines_(device), arena_(device) {
    upload_coverage(coverage_extent, coverage);
    const VkSamplerCreateInfo sampler{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                      .magFilter = VK_FILTER_LINEAR,
                                      .minFilter = VK_FILTER_LINEAR,
                                      .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                      .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
    VkSampler raw = VK_NULL_HANDLE;
    gpu::check(vkCreateSampler(device.handle(), &sampler, nullptr, &raw), "making a sampler");
    sampler_ = {device.handle(), raw};
}

Presenter::~Presenter() { vkQueueWaitIdle(device_.queue()); }

void Presenter::upload_coverage(VkExtent2D extent, std::span<const uint8_t> coverage) {
    if (coverage.size() != size_t(extent.width) * extent.height)
        throw Error("letters of an overlay: not a byte a texel");
    coverage_ = gpu::make_image(device_, gpu::image_info(kCoverageFormat, extent, 1,
                                                         VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT));
    arena_.bind(coverage_.get());
    coverage_view_ = gpu::make_view(device_, coverage_.get(), kCoverageFormat);
    const gpu::HostBuffer staging(device_, coverage.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                  gpu::HostBuffer::Direction::ToDevice);
    std::memcpy(staging.data(), coverage.data(), coverage.size());
    staging.flush();
    device_.run_once([&](VkCommandBuffer commands) {
        const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                     .imageExtent = {extent.width, extent.height, 1}};
        gpu::record_upload(commands, staging.buffer(), coverage_.get(), 1, {&copy, 1});
    });
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
    vkCmdSetCullMode(commands, VK_CULL_MODE_NONE);
    vkCmdSetFrontFace(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    Slot& slot = slots_[image.slot];
    if (!slot.descriptors) slot.descriptors.emplace(device_);
    slot.descriptors->reset();
    if (!picture.codes.empty() || picture.image) draw_picture(commands, image, picture, scaling, slot);
    if (!overlay.batches.empty()) draw_overlay(commands, image, overlay, slot);
    vkCmdEndRendering(commands);
}

void Presenter::upload(const Picture& picture, Slot& slot) const {
    const uint64_t pixels = uint64_t(picture.extent.width) * picture.extent.height;
    if (picture.codes.size() != pixels * 4) throw Error("a picture for a window: not four bytes a pixel");
    if (pixels > device_.most_texels(sizeof(uint32_t)))
        throw Error("a picture of " + std::to_string(picture.extent.width) + "x" +
                    std::to_string(picture.extent.height) + " is too large to be shown by " + device_.name());
    const bool storage = !device_.has_long_texel_buffers();
    if (slot.words.bytes() != pixels * 4) {
        slot.texels = {};
        slot.words =
            gpu::HostBuffer(device_, pixels * 4,
                            storage ? VK_BUFFER_USAGE_STORAGE_BUFFER_BIT : VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                            gpu::HostBuffer::Direction::ToDevice);
    }
    if (!storage && !slot.texels) {
        const VkBufferViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                          .buffer = slot.words.buffer(),
                                          .format = VK_FORMAT_R32_UINT,
                                          .range = VK_WHOLE_SIZE};
        VkBufferView view = VK_NULL_HANDLE;
        gpu::check(vkCreateBufferView(device_.handle(), &info, nullptr, &view), "viewing a picture");
        slot.texels = {device_.handle(), view};
    }
    std::memcpy(slot.words.data(), picture.codes.data(), picture.codes.size());
    slot.words.flush();
}

void Presenter::draw_picture(VkCommandBuffer commands, const WindowImage& image, const Picture& picture,
                             Scaling scaling, Slot& slot) {
    if (!picture.image) upload(picture, slot);
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
    const VkDescriptorBufferInfo words{slot.words.buffer(), 0, VK_WHOLE_SIZE};
    const VkDescriptorImageInfo texels{sampler_.get(), picture.image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    const gpu::GraphicsShaders& shaders = picture.image                      ? kPictureOfImage
                                          : device_.has_long_texel_buffers() ? kPicture
                                                                             : kPictureOfStorage;
    VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                               .descriptorCount = 1,
                               .descriptorType = shaders.bindings[0],
                               .pImageInfo = &texels,
                               .pBufferInfo = &words,
                               .pTexelBufferView = &view};
    const gpu::GraphicsPipeline& pipeline = pipelines_.get(shaders, {.targets = {{image.format}}});
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.pipeline());
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &at.area);
    slot.descriptors->bind(commands, pipeline, {&write, 1});
    vkCmdPushConstants(commands, pipeline.layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push, &push);
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
    VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                               .descriptorCount = 1,
                               .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                               .pImageInfo = &letters};
    const VkBuffer buffer = slot.vertices.buffer();
    const VkDeviceSize offset = 0;
    const gpu::GraphicsPipeline& pipeline = pipelines_.get(kOverlay, {.targets = {{image.format, true, true}}});
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.pipeline());
    vkCmdSetViewport(commands, 0, 1, &viewport);
    slot.descriptors->bind(commands, pipeline, {&write, 1});
    vkCmdPushConstants(commands, pipeline.layout(), kPushStages, 0, sizeof push, &push);
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

}  // namespace vesper::window
