#include "gpu/commands.h"

namespace vesper::gpu {

CommandBuffer::CommandBuffer(const Device& device, VkCommandPoolCreateFlags flags) : device_(device.handle()) {
    const VkCommandPoolCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, .flags = flags, .queueFamilyIndex = device.queue_family()};
    VkCommandPool raw = VK_NULL_HANDLE;
    check(vkCreateCommandPool(device_, &info, nullptr, &raw), "making a command pool");
    pool_ = {device_, raw};
    const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = raw,
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = 1};
    check(vkAllocateCommandBuffers(device_, &allocate, &commands_), "making a command buffer");
}

void CommandBuffer::begin() const {
    check(vkResetCommandPool(device_, pool_.get(), 0), "recording");
    const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                         .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    check(vkBeginCommandBuffer(commands_, &begin), "recording");
}

VkImageMemoryBarrier2 image_barrier(VkImage image, Touch before, Touch after, VkImageLayout from, VkImageLayout to,
                                    VkImageAspectFlags aspect, uint32_t levels) {
    return {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
            .srcStageMask = before.stages,
            .srcAccessMask = before.accesses,
            .dstStageMask = after.stages,
            .dstAccessMask = after.accesses,
            .oldLayout = from,
            .newLayout = to,
            .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .image = image,
            .subresourceRange = {aspect, 0, levels, 0, 1}};
}

void pipeline_barrier(VkCommandBuffer commands, std::span<const VkImageMemoryBarrier2> images,
                      const VkMemoryBarrier2* memory) {
    const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                      .memoryBarrierCount = memory ? 1u : 0u,
                                      .pMemoryBarriers = memory,
                                      .imageMemoryBarrierCount = uint32_t(images.size()),
                                      .pImageMemoryBarriers = images.data()};
    vkCmdPipelineBarrier2(commands, &dependency);
}

void record_upload(VkCommandBuffer commands, VkBuffer from, VkImage image, uint32_t levels,
                   std::span<const VkBufferImageCopy> copies, UploadPart part) {
    constexpr Touch copy{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
    constexpr Touch sample{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
    const auto change = [&](Touch before, Touch after, VkImageLayout old_layout, VkImageLayout new_layout) {
        const VkImageMemoryBarrier2 barrier =
            image_barrier(image, before, after, old_layout, new_layout, VK_IMAGE_ASPECT_COLOR_BIT, levels);
        pipeline_barrier(commands, {&barrier, 1});
    };
    if (part.first) change({}, copy, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(commands, from, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, uint32_t(copies.size()),
                           copies.data());
    if (part.last) change(copy, sample, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

}  // namespace vesper::gpu
