// Command buffers, and what separates the commands in them. SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "gpu/device.h"

namespace vesper::gpu {

/// A primary command buffer with a pool of its own.
class CommandBuffer {
public:
    CommandBuffer() = default;
    explicit CommandBuffer(const Device& device, VkCommandPoolCreateFlags flags = 0);
    void begin() const;  ///< from the start; for one submission
    operator VkCommandBuffer() const { return commands_; }

private:
    VkDevice device_ = VK_NULL_HANDLE;
    Owned<VkCommandPool, vkDestroyCommandPool> pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

/// Stages of work, and how they touch memory.
struct Touch {
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 accesses = VK_ACCESS_2_NONE;
};

/// The first levels of an image go from one layout to another, after `before` and ahead of `after`.
VkImageMemoryBarrier2 image_barrier(VkImage image, Touch before, Touch after, VkImageLayout from, VkImageLayout to,
                                    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT, uint32_t levels = 1);
void pipeline_barrier(VkCommandBuffer commands, std::span<const VkImageMemoryBarrier2> images,
                      const VkMemoryBarrier2* memory = nullptr);

/// Whether an upload is the first to an image, which is new then, and whether it is the last, after which fragment
/// shaders sample it. Between two of them the queue is waited for.
struct UploadPart {
    bool first = true, last = true;
};
/// Everything waits for everything that was written.
inline constexpr VkMemoryBarrier2 kWholeBarrier{
    .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
    .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
    .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
    .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
    .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};

/// Copies to the levels of an image that nothing else uses as yet.
void record_upload(VkCommandBuffer commands, VkBuffer from, VkImage image, uint32_t levels,
                   std::span<const VkBufferImageCopy> copies, UploadPart part = {});

}  // namespace vesper::gpu
