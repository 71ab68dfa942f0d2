// Descriptors of what is drawn or dispatched next. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gpu/graphics_pipeline.h"
#include "gpu/kernel.h"

namespace vesper::gpu {

/// Gives descriptors to one command buffer: pushes them where the device can, and otherwise takes sets from pools, of
/// which there become as many as its commands need.
class Descriptors {
public:
    explicit Descriptors(const Device& device) : device_(&device) {}

    /// For new commands. The device must have done those before.
    void reset();
    /// For the next dispatches or draws. `writes`: to all bindings; their sets are set here.
    void bind(VkCommandBuffer commands, const Kernel& kernel, std::span<VkWriteDescriptorSet> writes) {
        bind(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.set_layout(), kernel.layout(), writes);
    }
    void bind(VkCommandBuffer commands, const GraphicsPipeline& pipeline, std::span<VkWriteDescriptorSet> writes) {
        bind(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.set_layout(), pipeline.layout(), writes);
    }

private:
    void bind(VkCommandBuffer commands, VkPipelineBindPoint point, VkDescriptorSetLayout set, VkPipelineLayout layout,
              std::span<VkWriteDescriptorSet> writes);
    VkDescriptorSet take(VkDescriptorSetLayout layout);

    const Device* device_;
    std::vector<Owned<VkDescriptorPool, vkDestroyDescriptorPool>> pools_;
    size_t current_ = 0;  // the pools before it have no room left
};

}  // namespace vesper::gpu
