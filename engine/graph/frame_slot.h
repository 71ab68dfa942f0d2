// One of the frames that may be under way at once. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "gpu/commands.h"
#include "gpu/memory.h"

namespace vesper {

/// Semaphores of others around a frame.
struct Handover {
    std::span<const VkSemaphoreSubmitInfo> wait, signal;
};

/// A frame's commands, and what nobody else may touch before they are done.
struct FrameSlot {
    explicit FrameSlot(const Device& device);

    void begin(uint32_t timestamps);  ///< recording; `timestamps`: how many it writes
    void submit(const Handover& handover);
    void wait();  ///< until its frame, if it has one, is done

    const Device& device;
    HostBuffer uploads, readbacks;
    std::vector<OwnedBufferView> texels;
    std::vector<OwnedImageView> views;
    CommandBuffer commands;
    Owned<VkQueryPool, vkDestroyQueryPool> queries;
    uint32_t query_capacity = 0;
    OwnedFence fence;
    bool under_way = false;
};

}  // namespace vesper
