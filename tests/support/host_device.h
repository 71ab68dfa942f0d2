// A host with a device of its own, under validation, that lends it to Vesper; the host is that of the example.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <vesper/vulkan.h>

#include "../apps/examples/own-device/host.h"

namespace vesper::test {

/// What the host makes its device with. Change it before opening.
struct HostFeatures {
    VkPhysicalDeviceVulkan13Features f13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features f12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &f13};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &f12, {}};
};

/// A host, and what it tells Vesper of its device.
class HostDevice {
public:
    explicit HostDevice(const std::function<void(HostFeatures&, VkDeviceCreateInfo&)>& change = {})
        : physical_(instance_.first_device()) {
        asked_.f12.timelineSemaphore = VK_TRUE;
        VesperError error;
        if (vesper_device_features(physical_, &asked_.features, &error) != VESPER_OK)
            throw std::runtime_error(error.message);
        queue_info_.queueCount = 1, queue_info_.pQueuePriorities = &priority_;
        info_.pNext = &asked_.features;
        info_.queueCreateInfoCount = 1, info_.pQueueCreateInfos = &queue_info_;
        uint32_t used = 0;
        const char* const* names = vesper_device_extensions(&used);
        extensions_ = extensions_of(physical_, names, used);
        info_.enabledExtensionCount = uint32_t(extensions_.size());
        info_.ppEnabledExtensionNames = extensions_.data();
        if (change) change(asked_, info_);
        check(vkCreateDevice(physical_, &info_, nullptr, &device_), "opening a device");
        vkGetDeviceQueue(device_, 0, 0, &queue_);
        host_ = std::make_unique<Host>(physical_, device_, queue_, 0);
    }
    ~HostDevice() {
        host_.reset();
        vkDestroyDevice(device_, nullptr);
        EXPECT_EQ(instance_.messages(), 0u);
    }
    HostDevice(const HostDevice&) = delete;

    /// What vesper_device_borrow is given.
    VesperHostDevice lent() const {
        VesperHostDevice lent = VESPER_INIT(VesperHostDevice);
        lent.api_version = VK_API_VERSION_1_3, lent.instance = instance_.get();
        lent.physical_device = physical_, lent.device = device_, lent.created_with = &info_, lent.queue = queue_;
        return lent;
    }
    Host& operator*() { return *host_; }
    Host* operator->() { return host_.get(); }
    VkDevice device() const { return device_; }
    VkPhysicalDevice physical() const { return physical_; }
    bool validated() const { return instance_.validated(); }

private:
    Instance instance_;
    VkPhysicalDevice physical_;
    float priority_ = 1;
    std::vector<const char*> extensions_;
    HostFeatures asked_;
    VkDeviceQueueCreateInfo queue_info_{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    VkDeviceCreateInfo info_{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::unique_ptr<Host> host_;
};

/// Draws an image of floats pixel by pixel, and leaves it to be sampled.
inline void draw_pixels(VkCommandBuffer commands, const ::Image& image, VkExtent2D extent,
                        const std::vector<float>& rgb) {
    change_layout(commands, image.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    VkRenderingAttachmentInfo target{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    target.imageView = image.view, target.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    target.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR, target.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea.extent = extent, rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1, rendering.pColorAttachments = &target;
    vkCmdBeginRendering(commands, &rendering);
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        VkClearAttachment what{VK_IMAGE_ASPECT_COLOR_BIT, 0, {}};
        std::memcpy(what.clearValue.color.float32, &rgb[3 * i], 3 * sizeof(float));
        const VkClearRect where{{{int32_t(i % extent.width), int32_t(i / extent.width)}, {1, 1}}, 0, 1};
        vkCmdClearAttachments(commands, 1, &what, 1, &where);
    }
    vkCmdEndRendering(commands);
    change_layout(commands, image.image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

inline VesperImage described(const ::Image& image, VkFormat format, VkExtent2D extent, VkImageLayout before,
                             VkImageLayout after) {
    VesperImage made = VESPER_INIT(VesperImage);
    made.image = image.image, made.format = format, made.width = extent.width, made.height = extent.height;
    made.layout_before = before, made.layout_after = after;
    return made;
}

}  // namespace vesper::test
