#include "graph/frame_slot.h"

#include <bit>

namespace vesper::graph {

FrameSlot::FrameSlot(const gpu::Device& d) : device(d), commands(d), descriptors(d), fence(gpu::make_fence(d)) {}

void FrameSlot::begin(uint32_t timestamps) {
    commands.begin();
    descriptors.reset();
    if (query_capacity < timestamps) {
        const uint32_t count = std::bit_ceil(2 * timestamps);  // for frames with more passes, too
        const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                         .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                         .queryCount = count};
        VkQueryPool raw = VK_NULL_HANDLE;
        gpu::check(vkCreateQueryPool(device.handle(), &info, nullptr, &raw), "making timestamps");
        queries = {device.handle(), raw};
        query_capacity = count;
        ++device.use().objects;
    }
    if (timestamps) vkCmdResetQueryPool(commands, queries.get(), 0, timestamps);
}

void FrameSlot::submit(const SubmitSemaphores& semaphores) {
    gpu::check(vkEndCommandBuffer(commands), "recording");
    const VkCommandBufferSubmitInfo submitted{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                              .commandBuffer = commands};
    const VkSubmitInfo2 work{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                             .waitSemaphoreInfoCount = uint32_t(semaphores.wait.size()),
                             .pWaitSemaphoreInfos = semaphores.wait.data(),
                             .commandBufferInfoCount = 1,
                             .pCommandBufferInfos = &submitted,
                             .signalSemaphoreInfoCount = uint32_t(semaphores.signal.size()),
                             .pSignalSemaphoreInfos = semaphores.signal.data()};
    const VkFence done = fence.get();
    gpu::check(vkResetFences(device.handle(), 1, &done), "submitting a frame");
    device.submit(work, done, "submitting a frame");
    under_way = true;
}

void FrameSlot::wait() {
    if (!under_way) return;
    under_way = false;  // whatever comes of it
    device.wait(fence.get());
    if (readbacks.bytes()) readbacks.invalidate();
    read_timestamps();
}

bool FrameSlot::is_done() const { return !under_way || vkGetFenceStatus(device.handle(), fence.get()) != VK_NOT_READY; }

void FrameSlot::settle() noexcept {
    if (under_way) device.settle(fence.get());
    under_way = false;
}

// As FrameSlot::begin was told: two at each border of a pass.
void FrameSlot::read_timestamps() {
    if (timings.empty()) return;
    std::vector<uint64_t> ticks((timings.size() + 1) * 2);
    gpu::check(vkGetQueryPoolResults(device.handle(), queries.get(), 0, uint32_t(ticks.size()),
                                     ticks.size() * sizeof(uint64_t), ticks.data(), sizeof(uint64_t),
                                     VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
               "reading timestamps");
    for (size_t i = 0; i < timings.size(); ++i)
        timings[i].milliseconds = double((ticks[2 * (i + 1)] - ticks[2 * i]) & device.timestamp_mask()) *
                                  double(device.limits().timestampPeriod) * 1e-6;
}

}  // namespace vesper::graph
