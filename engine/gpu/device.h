// The Vulkan device: chosen, opened, and what owns things made from it. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <vulkan/vulkan.h>

#include "base/error.h"

namespace vesper::gpu {

/// The device is gone, and all that was made on it.
struct DeviceLost : Error {
    using Error::Error;
};
/// There is no more memory of the device; nothing else is wrong with it.
struct OutOfDeviceMemory : Error {
    using Error::Error;
};

/// Throws Error("<what>: <result>"), one of the two above or OutOfHostMemory, unless the result is VK_SUCCESS.
void check(VkResult result, std::string_view what);

/// Sole owner of a Vulkan object that is destroyed through its device.
template <class T, auto Destroy>
class Owned {
public:
    Owned() = default;
    Owned(VkDevice device, T handle) : device_(device), handle_(handle) {}
    Owned(Owned&& other) noexcept
        : device_(std::exchange(other.device_, VK_NULL_HANDLE)),
          handle_(std::exchange(other.handle_, VK_NULL_HANDLE)) {}
    Owned& operator=(Owned&& other) noexcept {
        std::swap(device_, other.device_), std::swap(handle_, other.handle_);
        return *this;
    }
    ~Owned() {
        if (handle_ != VK_NULL_HANDLE) Destroy(device_, handle_, nullptr);
    }
    T get() const { return handle_; }
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

private:
    VkDevice device_ = VK_NULL_HANDLE;
    T handle_ = VK_NULL_HANDLE;
};

/// What a window system asks of a device that is to show pictures in its windows.
struct Presentation {
    std::vector<std::string> instance_extensions;
    std::function<bool(VkInstance, VkPhysicalDevice, uint32_t family)>
        possible;  ///< whether a queue of this family can
};

struct DeviceOptions {
    std::string select;       ///< part of a name, "cpu", or an index; empty: VESPER_DEVICE, else the best there is
    bool as_gpu = false;      ///< use a CPU device as a GPU is used: what tests do where there is none
    bool as_least = false;    ///< use no extension and short texel buffers, as of a device that has no more: for tests
    bool validation = false;  ///< core, synchronization and best-practice-free checks of the Khronos layer
    std::function<void(const std::string&)> on_message;  ///< called for every validation message, on any thread
    std::optional<Presentation>
        presentation;  ///< for windows (window/swapchain.h); a device that shows none needs none
};

/// An external device: its owner made it, goes on using it, and destroys it.
struct BorrowedDevice {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    uint32_t queue_family = 0;
    uint32_t version = 0;                              ///< of the instance, VkApplicationInfo::apiVersion
    const VkDeviceCreateInfo* created_with = nullptr;  ///< what vkCreateDevice was given; not kept
    std::function<void()> lock, unlock;                ///< around every use of the queue; may be none
};

/// What a device has been asked for since it was opened.
struct DeviceUse {
    uint64_t bytes = 0, peak_bytes = 0;  ///< of its memory: allocated now, and at most at any time
    uint32_t pipelines = 0;              ///< made
    double pipeline_ms = 0;  ///< in the driver's calls that make them; some drivers compile later, at first use
    uint64_t submissions = 0, waits = 0;  ///< calls
    uint64_t objects = 0;                 ///< made: buffers, images, views, pieces of memory
};

/// One line per Vulkan device of the machine, for `--device`.
std::vector<std::string> list_devices();

class CommandBuffer;

/// An open Vulkan 1.3 device with one queue for graphics and compute. Preferred: discrete, integrated, then CPU.
class Device {
public:
    /// Throws Error with the reason for every device refused, or with what to install where there is none.
    explicit Device(const DeviceOptions& options = {});
    /// Uses a device, and destroys nothing of it. Throws Error naming all that it was made without.
    explicit Device(const BorrowedDevice& given);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    VkInstance instance() const { return instance_; }
    VkDevice handle() const { return device_; }
    VkPhysicalDevice physical() const { return physical_; }
    VkQueue queue() const { return queue_; }
    uint32_t queue_family() const { return queue_family_; }
    const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }
    bool is_cpu() const { return !as_gpu_ && properties_.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }
    bool borrowed() const { return borrowed_; }
    /// Whether eight invocations of a CPU device are taken side by side (glsl/lanes.glsl).
    bool has_lockstep() const { return is_cpu() && subgroup_size_ >= 8; }
    /// Whether buffers of any size can be read as texels; otherwise kernels read storage buffers (gpu/kernel_cache.h).
    bool has_long_texel_buffers() const;
    /// How many elements of `bytes` each a buffer that kernels read as texels may have.
    uint64_t most_texels(uint64_t bytes) const;
    bool has_timestamps() const { return timestamp_mask_ != 0; }
    uint64_t timestamp_mask() const { return timestamp_mask_; }  ///< the bits that its queue counts with
    bool has_anisotropy() const { return has_anisotropy_; }
    /// How many times longer than wide what a texel of a texture is taken for may be; 1 without anisotropy.
    float anisotropy() const { return has_anisotropy_ ? std::min(8.0f, limits().maxSamplerAnisotropy) : 1; }
    bool has_hdr_metadata() const { return has_hdr_metadata_; }  ///< VK_EXT_hdr_metadata; only with a presentation
    std::string name() const { return properties_.deviceName; }
    std::string driver() const { return driver_; }  ///< name and version

    /// A memory type among `allowed` (bits) with all `required` and, if there is one, all `preferred` properties.
    uint32_t memory_type(uint32_t allowed, VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred = 0) const;
    bool is_coherent(uint32_t memory_type) const;

    /// Kept by what is made on the device.
    DeviceUse& use() const { return use_; }

    /// Records and runs commands, and waits for them.
    void run_once(const std::function<void(VkCommandBuffer)>& record) const;
    /// Hands work to the queue. Throws Error saying `what` failed.
    void submit(const VkSubmitInfo2& work, VkFence fence, std::string_view what) const;
    void wait(VkFence fence) const;
    void settle(VkFence fence) const noexcept;  ///< waits too, as well as it can without memory

    PFN_vkCmdPushDescriptorSetKHR push_descriptors = nullptr;  ///< null where the device was made without

private:
    bool borrowed_ = false;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    uint32_t queue_family_ = 0;
    uint64_t timestamp_mask_ = 0;
    bool has_anisotropy_ = false, has_hdr_metadata_ = false;
    VkPhysicalDeviceProperties properties_{};
    VkPhysicalDeviceMemoryProperties memory_{};
    mutable DeviceUse use_;
    std::string driver_;
    bool as_gpu_ = false, as_least_ = false;
    uint32_t subgroup_size_ = 0;
    std::function<void(const std::string&)> on_message_;
    std::optional<Presentation> presentation_;
    std::function<void()> lock_, unlock_;

    std::string missing(VkPhysicalDevice device) const;
    std::optional<uint32_t> queue_family(VkPhysicalDevice device) const;
    void open_instance(bool validation);
    void choose(const std::string& select);
    void open_device();
    void learn(bool filters_along, bool pushes_descriptors);
    void close() noexcept;

    mutable std::unique_ptr<CommandBuffer>
        once_;  // of run_once, from the first on. A new one each time leaves 3 KB in the validation layer, for good
};

using OwnedFence = Owned<VkFence, vkDestroyFence>;
OwnedFence make_fence(const Device& device, VkFenceCreateFlags flags = 0);

}  // namespace vesper::gpu
