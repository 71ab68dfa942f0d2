// What stands for the resources of a frame on the device, for the executor alone. SPDX-License-Identifier: MIT
#pragma once

#include "graph/executor.h"

namespace vesper::graph {

/// Everything waits for everything that was written.
constexpr VkMemoryBarrier2 kWholeBarrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                         .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                         .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                         .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                         .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};

// A transient owns its objects; everything else borrows them from a history, the slot of the frame or an external
// owner.
struct Executor::Realized {
    gpu::OwnedImage owned_image;
    gpu::OwnedImageView owned_view;
    gpu::OwnedBuffer owned_buffer;
    gpu::OwnedBufferView owned_texels;
    VkBufferView texels = VK_NULL_HANDLE;
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
    uint64_t offset = 0, bytes = 0;
};

}  // namespace vesper::graph
