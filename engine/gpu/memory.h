// Device memory, and the buffers and images that live in it. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gpu/device.h"

namespace vesper::gpu {

using OwnedImage = Owned<VkImage, vkDestroyImage>;
using OwnedImageView = Owned<VkImageView, vkDestroyImageView>;
using OwnedBufferView = Owned<VkBufferView, vkDestroyBufferView>;
using OwnedSampler = Owned<VkSampler, vkDestroySampler>;

/// Sole owner of a buffer, and of the views of its texels.
class OwnedBuffer {
public:
    OwnedBuffer() = default;
    OwnedBuffer(const Device& device, VkBuffer buffer) : device_(&device), buffer_(device.handle(), buffer) {}

    VkBuffer get() const { return buffer_.get(); }
    explicit operator bool() const { return bool(buffer_); }
    /// Texels of `bytes` from `offset` on: a view that is made when it is asked for first, and lives as long as the
    /// buffer. Throws Error.
    VkBufferView texels(VkFormat format, uint64_t offset, uint64_t bytes) const;

private:
    struct View {
        VkFormat format;
        uint64_t offset, bytes;
        OwnedBufferView view;
    };
    const Device* device_ = nullptr;
    Owned<VkBuffer, vkDestroyBuffer> buffer_;
    mutable std::vector<View> views_;
};

/// Sole owner of a piece of device memory, of which the device keeps account.
class OwnedMemory {
public:
    OwnedMemory() = default;
    OwnedMemory(const Device& device, VkDeviceMemory memory, uint64_t bytes);
    OwnedMemory(OwnedMemory&& other) noexcept { *this = std::move(other); }
    OwnedMemory& operator=(OwnedMemory&& other) noexcept {
        std::swap(memory_, other.memory_), std::swap(use_, other.use_), std::swap(bytes_, other.bytes_);
        return *this;
    }
    ~OwnedMemory() {
        if (use_) use_->bytes -= bytes_;
    }
    VkDeviceMemory get() const { return memory_.get(); }

private:
    Owned<VkDeviceMemory, vkFreeMemory> memory_;
    DeviceUse* use_ = nullptr;
    uint64_t bytes_ = 0;
};

OwnedMemory allocate(const Device& device, uint64_t bytes, uint32_t memory_type);
OwnedBuffer make_buffer(const Device& device, uint64_t bytes, VkBufferUsageFlags usage);
VkImageCreateInfo image_info(VkFormat format, VkExtent2D extent, uint32_t levels, VkImageUsageFlags usage);
OwnedImage make_image(const Device& device, const VkImageCreateInfo& info);
OwnedImageView make_view(const Device& device, VkImage image, VkFormat format,
                         uint32_t levels = VK_REMAINING_MIP_LEVELS);
VkImageAspectFlags aspect_of(VkFormat format);

/// Host-visible memory with one buffer in it, mapped for as long as it lives.
class HostBuffer {
public:
    enum class Direction { ToDevice, FromDevice };
    HostBuffer() = default;
    HostBuffer(const Device& device, uint64_t bytes, VkBufferUsageFlags usage, Direction direction);

    VkBuffer buffer() const { return buffer_.get(); }
    const OwnedBuffer& owned() const { return buffer_; }
    uint64_t bytes() const { return bytes_; }
    std::byte* data() const { return data_; }
    void flush() const;       ///< makes host writes visible to the next submission
    void invalidate() const;  ///< makes finished device writes visible to the host

private:
    VkDevice device_ = VK_NULL_HANDLE;
    OwnedMemory memory_;
    OwnedBuffer buffer_;
    uint64_t bytes_ = 0;
    std::byte* data_ = nullptr;
    bool coherent_ = true;
};

/// Device-local memory for things that live and die together: handed out in order, freed at once.
class Arena {
public:
    static constexpr uint64_t kBlockBytes = 16ull << 20;
    /// `block`: least size of what is allocated at once, bytes; 0: what is bound, and no more.
    explicit Arena(const Device& device, uint64_t block = kBlockBytes) : device_(&device), block_(block) {}

    void bind(VkBuffer buffer);
    void bind(VkImage image);
    uint64_t bytes() const { return bytes_; }  ///< allocated from the device

private:
    struct Block {
        OwnedMemory memory;
        uint32_t type;
        uint64_t used, bytes;
    };
    std::pair<VkDeviceMemory, uint64_t> place(const VkMemoryRequirements& needs);

    const Device* device_;
    uint64_t block_;
    std::vector<Block> blocks_;
    uint64_t bytes_ = 0;
};

/// Of a buffer that kernels read as texels, either way (glsl/texels.glsl).
inline constexpr VkBufferUsageFlags kTexelUsage =
    VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
/// Copies bytes into a new device-local buffer, by way of a host buffer, and waits.
OwnedBuffer upload_buffer(const Device& device, Arena& arena, std::span<const std::byte> bytes,
                          VkBufferUsageFlags usage);

}  // namespace vesper::gpu
