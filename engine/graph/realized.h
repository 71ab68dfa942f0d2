// What stands for the resources of a frame on the device, for the executor alone. SPDX-License-Identifier: MIT
#pragma once

#include "graph/executor.h"

namespace vesper::graph {

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
