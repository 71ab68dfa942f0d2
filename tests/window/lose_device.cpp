// Stands before Vulkan (LD_PRELOAD) and loses the device once, at the submission LOSE_DEVICE_AT: from then on nothing
// answers until another device is opened. SPDX-License-Identifier: MIT
#include <dlfcn.h>
#include <vulkan/vulkan_core.h>

#include <cstdlib>

namespace {

bool lost = false;

template <typename Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

bool is_lost() {
    static const char* at = std::getenv("LOSE_DEVICE_AT");
    static int submissions = 0;
    if (at && ++submissions == std::atoi(at)) lost = true;
    return lost;
}

}  // namespace

extern "C" {

VKAPI_ATTR VkResult VKAPI_CALL vkQueueSubmit2(VkQueue queue, uint32_t count, const VkSubmitInfo2* submits,
                                              VkFence fence) {
    return is_lost() ? VK_ERROR_DEVICE_LOST
                     : next<decltype(vkQueueSubmit2)>("vkQueueSubmit2")(queue, count, submits, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL vkQueueWaitIdle(VkQueue queue) {
    return lost ? VK_ERROR_DEVICE_LOST : next<decltype(vkQueueWaitIdle)>("vkQueueWaitIdle")(queue);
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                              const VkAllocationCallbacks* memory, VkDevice* device) {
    lost = false;
    return next<decltype(vkCreateDevice)>("vkCreateDevice")(physical, info, memory, device);
}

}  // extern "C"
