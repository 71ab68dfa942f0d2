#include "gpu/kernel.h"

namespace vesper::gpu {

OwnedShaderModule make_shader(const Device& device, std::span<const uint32_t> spirv) {
    const VkShaderModuleCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = spirv.size_bytes(), .pCode = spirv.data()};
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device.handle(), &info, nullptr, &module), "loading a shader");
    return {device.handle(), module};
}

OwnedSetLayout make_set_layout(const Device& device, std::span<const VkDescriptorType> types,
                               VkShaderStageFlags stages) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const VkDescriptorType type : types)
        bindings.push_back(
            {.binding = uint32_t(bindings.size()), .descriptorType = type, .descriptorCount = 1, .stageFlags = stages});
    const VkDescriptorSetLayoutCreateFlags flags =
        device.push_descriptors ? VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR : 0;
    const VkDescriptorSetLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                               .flags = flags,
                                               .bindingCount = uint32_t(bindings.size()),
                                               .pBindings = bindings.data()};
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(device.handle(), &info, nullptr, &layout), "making a descriptor layout");
    return {device.handle(), layout};
}

OwnedPipelineLayout make_pipeline_layout(const Device& device, VkDescriptorSetLayout set, uint32_t push_bytes,
                                         VkShaderStageFlags push_stages) {
    const VkPushConstantRange range{.stageFlags = push_stages, .offset = 0, .size = push_bytes};
    const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                          .setLayoutCount = 1,
                                          .pSetLayouts = &set,
                                          .pushConstantRangeCount = push_bytes ? 1u : 0u,
                                          .pPushConstantRanges = &range};
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout), "making a pipeline layout");
    return {device.handle(), layout};
}

Specialization::Specialization(std::span<const uint32_t> constants) {
    for (uint32_t i = 0; i < constants.size(); ++i)
        entries_.push_back({i, i * uint32_t(sizeof(uint32_t)), sizeof(uint32_t)});
    info_ = {.mapEntryCount = uint32_t(entries_.size()),
             .pMapEntries = entries_.data(),
             .dataSize = constants.size_bytes(),
             .pData = constants.data()};
}

Kernel::Kernel(const Device& device, const std::string& shader, std::span<const uint32_t> spirv,
               std::initializer_list<uint32_t> constants)
    : KernelInterface(read_interface(shader, spirv)),
      device_(&device),
      set_(make_set_layout(device, bindings, VK_SHADER_STAGE_COMPUTE_BIT)),
      layout_(make_pipeline_layout(device, set_.get(), push_bytes, VK_SHADER_STAGE_COMPUTE_BIT)),
      constants_(constants),
      code_(spirv.begin(), spirv.end()) {}

VkPipeline Kernel::pipeline() const {
    if (!is_compiled()) {
        const PipelineTimer timer(*device_);
        compile();
    }
    return pipeline_.get();
}

void Kernel::compile() const {
    const Specialization specialization(constants_);
    const OwnedShaderModule module = make_shader(*device_, code_);
    const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                           .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                     .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                     .module = module.get(),
                                                     .pName = "main",
                                                     .pSpecializationInfo = specialization.info()},
                                           .layout = layout_.get()};
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(device_->handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
          "compiling " + name);
    pipeline_ = {device_->handle(), pipeline};
    code_ = {};
}

}  // namespace vesper::gpu
