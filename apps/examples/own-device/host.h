// A host's own Vulkan: a device, images, and frames that are recorded and submitted. Nothing of Vesper.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

inline void check(VkResult result, const char* what) {
    if (result != VK_SUCCESS) throw std::runtime_error(std::string(what) + ": Vulkan result " + std::to_string(result));
}

/// An instance with the validation layer, where that is installed, whose messages are counted.
class Instance {
public:
    /// With further extensions, such as those of a window.
    explicit Instance(std::vector<const char*> extensions = {});
    ~Instance();
    VkInstance get() const { return instance_; }
    VkPhysicalDevice first_device() const;
    bool validated() const { return messenger_ != VK_NULL_HANDLE; }
    unsigned messages() const { return messages_; }

private:
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    unsigned messages_ = 0;
};

/// Of these device extensions, those that a device has.
std::vector<const char*> extensions_of(VkPhysicalDevice device, const char* const* names, uint32_t count);

struct Image {
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
};

/// What the host does with a device that somebody made for it.
class Host {
public:
    Host(VkPhysicalDevice physical, VkDevice device, VkQueue queue, uint32_t family);
    ~Host();

    Image make_image(VkFormat format, VkExtent2D extent, VkImageUsageFlags usage);
    void destroy(Image& image);
    /// Records commands and hands them to the queue; the timeline reaches `signal` when they are done.
    void submit(const std::function<void(VkCommandBuffer)>& record, uint64_t signal);
    void wait(uint64_t value) const;
    VkSemaphore timeline() const { return timeline_; }
    /// Contents of an image of 4 bytes a pixel in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL.
    std::vector<uint8_t> read(const Image& image, VkExtent2D extent, uint64_t signal);

private:
    uint32_t memory_type(uint32_t allowed, VkMemoryPropertyFlags properties) const;

    VkPhysicalDevice physical_;
    VkDevice device_;
    VkQueue queue_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkSemaphore timeline_ = VK_NULL_HANDLE;
    std::vector<VkCommandBuffer> commands_;  // all frames', until the end: there are few
};

/// A new layout, after everything before and before everything behind.
void change_layout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to);
