#include "host.h"

#include <cstdio>
#include <cstring>

namespace {

constexpr const char* kLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL count(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                     const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    ++*static_cast<unsigned*>(user);
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    return VK_FALSE;
}

bool has_layer() {
    uint32_t found = 0;
    vkEnumerateInstanceLayerProperties(&found, nullptr);
    std::vector<VkLayerProperties> layers(found);
    vkEnumerateInstanceLayerProperties(&found, layers.data());
    for (const VkLayerProperties& layer : layers)
        if (!std::strcmp(layer.layerName, kLayer)) return true;
    return false;
}

}  // namespace

std::vector<const char*> extensions_of(VkPhysicalDevice device, const char* const* names, uint32_t count) {
    uint32_t found = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &found, nullptr);
    std::vector<VkExtensionProperties> extensions(found);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &found, extensions.data());
    std::vector<const char*> had;
    for (uint32_t i = 0; i < count; ++i)
        for (const VkExtensionProperties& extension : extensions)
            if (!std::strcmp(extension.extensionName, names[i])) had.push_back(names[i]);
    return had;
}

Instance::Instance(std::vector<const char*> extensions) {
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = VK_API_VERSION_1_3;
    VkDebugUtilsMessengerCreateInfoEXT messages{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messages.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messages.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messages.pfnUserCallback = count, messages.pUserData = &messages_;
    const VkValidationFeatureEnableEXT enable = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &messages, 1, &enable, 0, nullptr};
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    const bool validated = has_layer();
    if (validated) {
        info.pNext = &features;
        info.enabledLayerCount = 1, info.ppEnabledLayerNames = &kLayer;
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }
    info.enabledExtensionCount = uint32_t(extensions.size()), info.ppEnabledExtensionNames = extensions.data();
    check(vkCreateInstance(&info, nullptr, &instance_), "opening Vulkan");
    if (!validated) return;
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    check(create(instance_, &messages, nullptr, &messenger_), "listening to validation");
}

Instance::~Instance() {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    if (messenger_) destroy(instance_, messenger_, nullptr);
    vkDestroyInstance(instance_, nullptr);
}

VkPhysicalDevice Instance::first_device() const {
    uint32_t one = 1;
    VkPhysicalDevice device = VK_NULL_HANDLE;
    const VkResult result = vkEnumeratePhysicalDevices(instance_, &one, &device);
    if (result != VK_INCOMPLETE) check(result, "listing devices");
    if (!device) throw std::runtime_error("no Vulkan device");
    return device;
}

Host::Host(VkPhysicalDevice physical, VkDevice device, VkQueue queue, uint32_t family)
    : physical_(physical), device_(device), queue_(queue) {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = family;
    check(vkCreateCommandPool(device, &pool, nullptr, &pool_), "making a command pool");
    VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type, 0};
    check(vkCreateSemaphore(device, &semaphore, nullptr, &timeline_), "making a semaphore");
}

Host::~Host() {
    vkQueueWaitIdle(queue_);
    vkDestroySemaphore(device_, timeline_, nullptr);
    vkDestroyCommandPool(device_, pool_, nullptr);
}

uint32_t Host::memory_type(uint32_t allowed, VkMemoryPropertyFlags properties) const {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory);
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
        if ((allowed >> i & 1) && (memory.memoryTypes[i].propertyFlags & properties) == properties) return i;
    throw std::runtime_error("no such memory");
}

Image Host::make_image(VkFormat format, VkExtent2D extent, VkImageUsageFlags usage) {
    Image made;
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D, info.format = format, info.extent = {extent.width, extent.height, 1};
    info.mipLevels = info.arrayLayers = 1, info.samples = VK_SAMPLE_COUNT_1_BIT, info.usage = usage;
    check(vkCreateImage(device_, &info, nullptr, &made.image), "making an image");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device_, made.image, &needs);
    const VkMemoryAllocateInfo memory{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size,
                                      memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)};
    check(vkAllocateMemory(device_, &memory, nullptr, &made.memory), "allocating");
    check(vkBindImageMemory(device_, made.image, made.memory, 0), "binding an image");
    if (!(usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)) return made;
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = made.image, view.viewType = VK_IMAGE_VIEW_TYPE_2D, view.format = format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    check(vkCreateImageView(device_, &view, nullptr, &made.view), "viewing an image");
    return made;
}

void Host::destroy(Image& image) {
    vkDestroyImageView(device_, image.view, nullptr);
    vkDestroyImage(device_, image.image, nullptr);
    vkFreeMemory(device_, image.memory, nullptr);
    image = {};
}

void Host::submit(const std::function<void(VkCommandBuffer)>& record, uint64_t signal) {
    const VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool_,
                                               VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check(vkAllocateCommandBuffers(device_, &allocate, &commands), "making a command buffer");
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands, &begin), "recording");
    record(commands);
    check(vkEndCommandBuffer(commands), "recording");
    VkCommandBufferSubmitInfo work{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    work.commandBuffer = commands;
    VkSemaphoreSubmitInfo done{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    done.semaphore = timeline_, done.value = signal, done.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1, submit.pCommandBufferInfos = &work;
    submit.signalSemaphoreInfoCount = 1, submit.pSignalSemaphoreInfos = &done;
    check(vkQueueSubmit2(queue_, 1, &submit, VK_NULL_HANDLE), "submitting");
    commands_.push_back(commands);
}

void Host::wait(uint64_t value) const {
    VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    info.semaphoreCount = 1, info.pSemaphores = &timeline_, info.pValues = &value;
    check(vkWaitSemaphores(device_, &info, UINT64_MAX), "waiting");
}

std::vector<uint8_t> Host::read(const Image& image, VkExtent2D extent, uint64_t signal) {
    const VkDeviceSize bytes = VkDeviceSize{4} * extent.width * extent.height;
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes, info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    check(vkCreateBuffer(device_, &info, nullptr, &buffer), "making a buffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_, buffer, &needs);
    const VkMemoryPropertyFlags visible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size,
                                        memory_type(needs.memoryTypeBits, visible)};
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(vkAllocateMemory(device_, &allocate, nullptr, &memory), "allocating");
    check(vkBindBufferMemory(device_, buffer, memory, 0), "binding a buffer");
    submit(
        [&](VkCommandBuffer commands) {
            VkBufferImageCopy region{};
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
            region.imageExtent = {extent.width, extent.height, 1};
            vkCmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &region);
            VkMemoryBarrier2 to_host{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr,
                                     VK_PIPELINE_STAGE_2_COPY_BIT,       VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                     VK_PIPELINE_STAGE_2_HOST_BIT,       VK_ACCESS_2_HOST_READ_BIT};
            VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
            dependency.memoryBarrierCount = 1, dependency.pMemoryBarriers = &to_host;
            vkCmdPipelineBarrier2(commands, &dependency);
        },
        signal);
    wait(signal);
    void* data = nullptr;
    check(vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &data), "mapping");
    std::vector<uint8_t> read(static_cast<uint8_t*>(data), static_cast<uint8_t*>(data) + bytes);
    vkDestroyBuffer(device_, buffer, nullptr);
    vkFreeMemory(device_, memory, nullptr);
    return read;
}

void change_layout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.oldLayout = from, barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image, barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1, dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}
