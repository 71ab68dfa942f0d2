// What the engine needs of a Vulkan device, whoever makes it. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>

#include <vulkan/vulkan.h>

namespace vesper::gpu {

constexpr uint32_t kVulkanVersion = VK_API_VERSION_1_3;
/// What the engine uses where a device has it.
constexpr std::array<const char*, 1> kDeviceExtensions{VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
/// Elements of a texel buffer: what any device has, and what is taken to be enough for all buffers.
constexpr uint32_t kLeastTexelBuffer = 1u << 16, kLongTexelBuffer = 1u << 27;

/// Everything that a physical device lacks, with commas; empty: nothing.
std::string missing_support(VkPhysicalDevice);
/// Everything that a device was made without, likewise. `version` is that of its instance
/// (VkApplicationInfo::apiVersion).
std::string missing_of(const VkDeviceCreateInfo&, uint32_t version);

/// Sets the features that the engine needs, and anisotropic filtering where there is any; leaves others as they are.
/// The chain holds the structures of Vulkan 1.2 and 1.3, or those of the extensions that became part of these. Throws
/// Error naming the features that have no place in it.
void enable_features(VkPhysicalDevice, VkPhysicalDeviceFeatures2& chain);
/// Whether a device was made with anisotropic filtering.
bool filters_along(const VkDeviceCreateInfo&);
/// Whether a device was made with push descriptors.
bool pushes_descriptors(const VkDeviceCreateInfo&);

bool has_extension(VkPhysicalDevice, const char* name);
/// Name and version of the driver of a device of Vulkan 1.2 or later.
std::string driver_of(VkPhysicalDevice);
/// "NAME (KIND, Vulkan VERSION, DRIVER)"; the driver from Vulkan 1.2 on.
std::string described(VkPhysicalDevice);
/// Whether a queue family is for graphics and compute.
bool is_queue_family(VkPhysicalDevice, uint32_t family);

}  // namespace vesper::gpu
