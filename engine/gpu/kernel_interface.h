// What a compute shader asks for, read from its SPIR-V: needs no device. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace vesper::gpu {

/// Bindings, push constants and workgroup of a compute shader.
struct KernelInterface {
    std::string name;                        ///< of the shader file, for messages
    std::vector<VkDescriptorType> bindings;  ///< of set 0; binding i is the i-th, without gaps
    uint32_t push_bytes = 0;                 ///< size of the push-constant block, bytes; 0 without one
    std::array<uint32_t, 3> group{1, 1, 1};  ///< invocations per workgroup, before specialization
    bool texels_in_storage = false;          ///< it is Shader::storage (gpu/kernel_cache.h)
};

/// Reads the interface of a SPIR-V module. Throws Error naming the shader when bindings have gaps, lie outside set 0,
/// or are of a kind the engine does not use.
KernelInterface read_interface(const std::string& name, std::span<const uint32_t> spirv);

/// A member of a block of a SPIR-V module and where it lies.
struct BlockMember {
    std::string block, member;
    uint32_t offset = 0;  ///< bytes
};

/// Every named member of every structure with explicit layout, for comparing with offsetof.
std::vector<BlockMember> block_members(std::span<const uint32_t> spirv);

}  // namespace vesper::gpu
