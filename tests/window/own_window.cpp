// A window of the host's: Vesper renders into the images of its swapchain, between the semaphores of taking and showing
// them, and the validation layer watches. Ends with 77 where there is nothing to open a window on.
// SPDX-License-Identifier: MIT
#include <cstdio>

#include <vulkan/vulkan.h>

#include <GLFW/glfw3.h>
#include <vesper/vulkan.h>
#include <vesper/vesper.hpp>

#include "../apps/examples/own-device/host.h"

using namespace vesper::cpp;

namespace {

constexpr unsigned kFrames = 8;

VkSemaphore make_semaphore(VkDevice device) {
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore made = VK_NULL_HANDLE;
    check(vkCreateSemaphore(device, &info, nullptr, &made), "making a semaphore");
    return made;
}

VkSemaphoreSubmitInfo at_all_commands(VkSemaphore semaphore) {
    VkSemaphoreSubmitInfo made{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    made.semaphore = semaphore, made.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    return made;
}

void render(const VesperHostDevice& lent, VkSwapchainKHR swapchain, const VkSwapchainCreateInfoKHR& made) {
    uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(lent.device, swapchain, &count, nullptr), "listing images");
    std::vector<VkImage> images(count);
    check(vkGetSwapchainImagesKHR(lent.device, swapchain, &count, images.data()), "listing images");
    std::vector<VkSemaphore> acquired, drawn;
    for (uint32_t i = 0; i < count; ++i)
        acquired.push_back(make_semaphore(lent.device)), drawn.push_back(make_semaphore(lent.device));
    {
        const Device device = make<Device>(vesper_device_borrow, &lent);
        const Scene scene = make<Scene>(vesper_scene_create);
        const float lux[3]{}, sky[3]{3, 2, 1};
        call(vesper_scene_set_sky, scene.get(), lux, sky);
        const Renderer renderer = make<Renderer>(vesper_renderer_create, device.get(), scene.get());
        const VesperToneSettings settings = default_tone_settings();
        auto view = sized<VesperView>();
        view.width = made.imageExtent.width, view.height = made.imageExtent.height;
        view.forward[2] = -1, view.up[1] = 1, view.vertical_fov = 0.7f, view.near_plane = 0.1f;
        for (unsigned frame = 0; frame < kFrames; ++frame) {
            uint32_t next = 0;
            check(vkAcquireNextImageKHR(lent.device, swapchain, UINT64_MAX, acquired[frame % count], VK_NULL_HANDLE,
                                        &next),
                  "taking an image");
            auto to = sized<VesperImage>();
            to.image = images[next], to.format = made.imageFormat, to.width = view.width, to.height = view.height;
            to.layout_before = VK_IMAGE_LAYOUT_UNDEFINED, to.layout_after = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
            const VkSemaphoreSubmitInfo on_acquired = at_all_commands(acquired[frame % count]),
                                        on_drawn = at_all_commands(drawn[next]);
            auto handover = sized<VesperHandover>();
            handover.wait_count = handover.signal_count = 1, handover.waits = &on_acquired,
            handover.signals = &on_drawn;
            call(vesper_render_image, renderer.get(), &settings, &view, 0.02f, &to, &handover);
            VkPresentInfoKHR present{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
            present.waitSemaphoreCount = 1, present.pWaitSemaphores = &drawn[next];
            present.swapchainCount = 1, present.pSwapchains = &swapchain, present.pImageIndices = &next;
            check(vkQueuePresentKHR(lent.queue, &present), "showing an image");
            glfwPollEvents();
        }
        auto report = sized<VesperFrameReport>();
        call(vesper_renderer_finish, renderer.get(), &report);
        if (!(report.adaptation > 0)) throw std::runtime_error("nothing was seen");
    }
    check(vkQueueWaitIdle(lent.queue), "waiting");
    for (const VkSemaphore semaphore : acquired) vkDestroySemaphore(lent.device, semaphore, nullptr);
    for (const VkSemaphore semaphore : drawn) vkDestroySemaphore(lent.device, semaphore, nullptr);
}

void run(const Instance& instance, GLFWwindow* window) {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    check(glfwCreateWindowSurface(instance.get(), window, nullptr, &surface), "making a surface");
    const VkPhysicalDevice physical = instance.first_device();
    VkBool32 supported = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(physical, 0, surface, &supported), "asking for a queue");
    if (!supported) throw std::runtime_error("the device cannot show pictures in a window");
    VkPhysicalDeviceVulkan13Features f13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features f12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &f13};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &f12, {}};
    call(vesper_device_features, physical, &features);
    uint32_t count = 0;
    const char* const* used = vesper_device_extensions(&count);
    std::vector<const char*> extensions = extensions_of(physical, used, count);
    extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, 0, 1, &priority};
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
    info.queueCreateInfoCount = 1, info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = uint32_t(extensions.size()), info.ppEnabledExtensionNames = extensions.data();
    auto lent = sized<VesperHostDevice>();
    lent.api_version = VK_API_VERSION_1_3, lent.instance = instance.get(), lent.physical_device = physical,
    lent.created_with = &info;
    check(vkCreateDevice(physical, &info, nullptr, &lent.device), "opening the device");
    vkGetDeviceQueue(lent.device, 0, 0, &lent.queue);

    VkSurfaceCapabilitiesKHR can;
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physical, surface, &can), "asking for a surface");
    VkSwapchainCreateInfoKHR wanted{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    wanted.surface = surface, wanted.minImageCount = can.minImageCount, wanted.imageArrayLayers = 1;
    wanted.imageFormat = VK_FORMAT_B8G8R8A8_UNORM, wanted.imageExtent = can.currentExtent,
    wanted.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    wanted.preTransform = can.currentTransform, wanted.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
    wanted.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    VkSwapchainKHR swapchain = VK_NULL_HANDLE;
    check(vkCreateSwapchainKHR(lent.device, &wanted, nullptr, &swapchain), "making a swapchain");
    render(lent, swapchain, wanted);
    vkDestroySwapchainKHR(lent.device, swapchain, nullptr);
    vkDestroyDevice(lent.device, nullptr);
    vkDestroySurfaceKHR(instance.get(), surface, nullptr);
}

}  // namespace

int main() try {
    if (!glfwInit() || !glfwVulkanSupported()) return 77;
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    GLFWwindow* window = glfwCreateWindow(96, 60, "own window", nullptr, nullptr);
    uint32_t count = 0;
    const char** extensions = glfwGetRequiredInstanceExtensions(&count);
    if (!window || !extensions) return 77;
    const Instance instance(std::vector<const char*>(extensions, extensions + count));
    run(instance, window);
    glfwDestroyWindow(window);
    glfwTerminate();
    return instance.messages() ? 1 : 0;
} catch (const std::exception& failure) {
    std::fprintf(stderr, "own_window: %s\n", failure.what());
    return 1;
}
