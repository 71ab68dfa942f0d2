// What stands for the resources of a frame on the device, for the executor alone. SPDX-License-Identifier: MIT
#pragma once

#include "graph/executor.h"

namespace vesper::graph {

// Of a transient, a history, the slot of the frame or an external owner.
struct Executor::Realized {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
    const gpu::OwnedBuffer* buffer = nullptr;
    uint64_t offset = 0, bytes = 0;
    uint64_t viewed_bytes = 0;  // of its texels, at least `bytes`: the same in all frames where it can be
};

}  // namespace vesper::graph
