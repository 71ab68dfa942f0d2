#include "gpu/descriptors.h"

#include <array>

namespace vesper::gpu {
namespace {

// Of a pool: sets, and descriptors of each kind. More than any one pipeline has of a kind.
constexpr uint32_t kSets = 64, kOfAKind = 256;
constexpr std::array kKinds{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                            VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,          VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                            VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER,   VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                            VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};

Owned<VkDescriptorPool, vkDestroyDescriptorPool> make_pool(VkDevice device) {
    std::array<VkDescriptorPoolSize, kKinds.size()> sizes;
    for (size_t i = 0; i < kKinds.size(); ++i) sizes[i] = {kKinds[i], kOfAKind};
    const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .maxSets = kSets,
                                          .poolSizeCount = uint32_t(sizes.size()),
                                          .pPoolSizes = sizes.data()};
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device, &info, nullptr, &pool), "making a pool of descriptors");
    return {device, pool};
}

}  // namespace

void Descriptors::reset() {
    for (const auto& pool : pools_)
        check(vkResetDescriptorPool(device_->handle(), pool.get(), 0), "emptying a pool of descriptors");
    current_ = 0;
}

VkDescriptorSet Descriptors::take(VkDescriptorSetLayout layout) {
    for (;; ++current_) {
        const bool is_new = current_ == pools_.size();
        if (is_new) pools_.push_back(make_pool(device_->handle()));
        const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .descriptorPool = pools_[current_].get(),
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &layout};
        VkDescriptorSet set = VK_NULL_HANDLE;
        const VkResult result = vkAllocateDescriptorSets(device_->handle(), &info, &set);
        const bool full = result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL;
        if (full && !is_new) continue;
        check(result, "making descriptors");
        return set;
    }
}

void Descriptors::bind(VkCommandBuffer commands, VkPipelineBindPoint point, VkDescriptorSetLayout set_layout,
                       VkPipelineLayout layout, std::span<VkWriteDescriptorSet> writes) {
    if (device_->push_descriptors)
        return device_->push_descriptors(commands, point, layout, 0, uint32_t(writes.size()), writes.data());
    const VkDescriptorSet set = take(set_layout);
    for (VkWriteDescriptorSet& write : writes) write.dstSet = set;
    vkUpdateDescriptorSets(device_->handle(), uint32_t(writes.size()), writes.data(), 0, nullptr);
    vkCmdBindDescriptorSets(commands, point, layout, 0, 1, &set, 0, nullptr);
}

}  // namespace vesper::gpu
