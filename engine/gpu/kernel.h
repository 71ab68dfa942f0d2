// A compute pipeline made from one shader. SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "base/stopwatch.h"
#include "gpu/device.h"
#include "gpu/kernel_interface.h"

namespace vesper::gpu {

using OwnedSetLayout = Owned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;
using OwnedPipelineLayout = Owned<VkPipelineLayout, vkDestroyPipelineLayout>;
using OwnedPipeline = Owned<VkPipeline, vkDestroyPipeline>;
using OwnedShaderModule = Owned<VkShaderModule, vkDestroyShaderModule>;

/// Lives while pipelines are made, and adds them to the device's account.
class PipelineTimer {
public:
    explicit PipelineTimer(const Device& device, size_t count = 1) : use_(device.use()), count_(uint32_t(count)) {}
    PipelineTimer(const PipelineTimer&) = delete;
    PipelineTimer& operator=(const PipelineTimer&) = delete;
    ~PipelineTimer() { use_.pipelines += count_, use_.pipeline_ms += watch_.milliseconds(); }

private:
    DeviceUse& use_;
    uint32_t count_;
    Stopwatch watch_;
};

OwnedShaderModule make_shader(const Device& device, std::span<const uint32_t> spirv);
/// The layout of a set, binding i of kind types[i]; of push descriptors where the device has them (gpu/descriptors.h).
OwnedSetLayout make_set_layout(const Device& device, std::span<const VkDescriptorType> types,
                               VkShaderStageFlags stages);
OwnedPipelineLayout make_pipeline_layout(const Device& device, VkDescriptorSetLayout set, uint32_t push_bytes,
                                         VkShaderStageFlags push_stages);

/// What a shader is specialized with: constant i is constants[i]. Refers to them.
class Specialization {
public:
    explicit Specialization(std::span<const uint32_t> constants);
    Specialization(const Specialization&) = delete;
    Specialization& operator=(const Specialization&) = delete;
    const VkSpecializationInfo* info() const { return &info_; }

private:
    std::vector<VkSpecializationMapEntry> entries_;
    VkSpecializationInfo info_{};
};

/// A compute shader, ready to dispatch. Specialization constant i is constants[i]. The driver compiles it when its
/// pipeline is first asked for, or before that by compile(), which several threads may call for kernels of their own.
class Kernel : public KernelInterface {
public:
    Kernel(const Device& device, const std::string& name, std::span<const uint32_t> spirv,
           std::initializer_list<uint32_t> constants = {});

    /// Throws Error.
    VkPipeline pipeline() const;
    bool is_compiled() const { return bool(pipeline_); }
    /// Without the device's account. Throws Error.
    void compile() const;
    size_t code_words() const { return code_.size(); }  ///< until it is compiled
    VkPipelineLayout layout() const { return layout_.get(); }
    VkDescriptorSetLayout set_layout() const { return set_.get(); }

private:
    const Device* device_;
    OwnedSetLayout set_;
    OwnedPipelineLayout layout_;
    std::vector<uint32_t> constants_;
    mutable std::vector<uint32_t> code_;
    mutable OwnedPipeline pipeline_;
};

}  // namespace vesper::gpu
