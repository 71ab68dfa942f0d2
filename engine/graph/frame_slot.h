// One of the frames that may be under way at once. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "gpu/commands.h"
#include "gpu/descriptors.h"
#include "gpu/memory.h"

namespace vesper::graph {

/// Semaphores that a submitted frame waits for, and those that it signals.
struct SubmitSemaphores {
    std::span<const VkSemaphoreSubmitInfo> wait, signal;
};

/// Device time of one pass of a frame, and what it had to move (Plan::Step).
struct Timing {
    std::string pass;
    double milliseconds = 0;
    uint64_t bytes_read = 0, bytes_written = 0;
};

/// Where the host's time went for a frame, ms.
struct HostTimes {
    double declare = 0;  ///< lists of lamps, the frame's declaration; of whoever runs the executor
    double plan = 0;     ///< compiling the plan, placing resources, writing uploads
    double record = 0;
    double submit = 0;
    double wait = 0;  ///< for the device
};

/// Commands of a frame in flight, and the resources that only they use.
struct FrameSlot {
    explicit FrameSlot(const gpu::Device& device);

    void begin(uint32_t timestamps);  ///< recording; `timestamps`: how many it writes
    void submit(const SubmitSemaphores& semaphores);
    void wait();             ///< until its frame, if it has one, is done; then there are its timings
    bool is_done() const;    ///< wait() would return at once
    void settle() noexcept;  ///< waits without reading timings, before resources are destroyed

    const gpu::Device& device;
    gpu::HostBuffer uploads, readbacks;
    struct Slice {
        uint64_t offset = 0, bytes = 0;
    };
    std::map<uint32_t, Slice> places;  // in `readbacks`, by resource
    std::vector<Timing> timings;
    HostTimes host_times;
    std::vector<gpu::OwnedImageView> views;
    gpu::CommandBuffer commands;
    gpu::Descriptors descriptors;
    gpu::Owned<VkQueryPool, vkDestroyQueryPool> queries;
    uint32_t query_capacity = 0;
    gpu::OwnedFence fence;
    bool under_way = false;

private:
    void read_timestamps();
};

}  // namespace vesper::graph
