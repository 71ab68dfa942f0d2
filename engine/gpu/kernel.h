// A compute pipeline made from one shader. SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <span>
#include <string>

#include "gpu/device.h"
#include "gpu/kernel_interface.h"

namespace vesper {

using OwnedSetLayout = Owned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;
using OwnedPipelineLayout = Owned<VkPipelineLayout, vkDestroyPipelineLayout>;
using OwnedPipeline = Owned<VkPipeline, vkDestroyPipeline>;
using OwnedShaderModule = Owned<VkShaderModule, vkDestroyShaderModule>;

OwnedShaderModule make_shader(const Device& device, std::span<const uint32_t> spirv);
/// A layout of push descriptors, binding i of kind types[i].
OwnedSetLayout make_set_layout(const Device& device, std::span<const VkDescriptorType> types, VkShaderStageFlags stages);
OwnedPipelineLayout make_pipeline_layout(const Device& device, VkDescriptorSetLayout set, uint32_t push_bytes,
                                         VkShaderStageFlags push_stages);

/// A compute shader, ready to dispatch. Specialization constant i is constants[i].
class Kernel : public KernelInterface {
public:
    Kernel(const Device& device, const std::string& name, std::span<const uint32_t> spirv,
           std::initializer_list<uint32_t> constants = {});

    VkPipeline pipeline() const { return pipeline_.get(); }
    VkPipelineLayout layout() const { return layout_.get(); }

private:
    OwnedSetLayout set_;
    OwnedPipelineLayout layout_;
    OwnedPipeline pipeline_;
};

}  // namespace vesper
