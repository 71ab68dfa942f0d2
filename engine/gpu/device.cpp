#include "gpu/device.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "base/lower.h"
#include "gpu/commands.h"
#include "gpu/requirements.h"

namespace vesper::gpu {
namespace {

constexpr const char* kInstall =
    "no Vulkan device: install a driver (Debian, Ubuntu: apt install mesa-vulkan-drivers for a CPU device, or your "
    "GPU's own driver)";
constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL forward_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                               const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    const auto& sink = *static_cast<std::function<void(const std::string&)>*>(user);
    if (sink) sink(data->pMessage);
    return VK_FALSE;
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance) {
    uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "listing Vulkan devices");
    std::vector<VkPhysicalDevice> devices(count);
    check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "listing Vulkan devices");
    return devices;
}

bool has_instance_extension(const char* name) {
    uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> all(count);
    vkEnumerateInstanceExtensionProperties(nullptr, &count, all.data());
    return std::any_of(all.begin(), all.end(), [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

/// The first family for graphics and compute that `also` takes.
std::optional<uint32_t> graphics_queue_family(VkPhysicalDevice device, const std::function<bool(uint32_t)>& also = {}) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    for (uint32_t i = 0; i < count; ++i)
        if (is_queue_family(device, i) && (!also || also(i))) return i;
    return std::nullopt;
}

/// Why the engine cannot run on a device; empty if it can.
std::string missing(VkPhysicalDevice device) {
    const std::string names = missing_support(device);
    return names.empty() ? "" : "no " + names;
}

int rank(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 0;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 1;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 2;
        default:
            return 3;
    }
}

bool matches(const std::string& select, size_t index, const VkPhysicalDeviceProperties& properties) {
    if (select.empty()) return true;
    if (std::all_of(select.begin(), select.end(), [](unsigned char c) { return std::isdigit(c); }))
        return select == std::to_string(index);
    if (lower(select) == "cpu") return properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    return lower(properties.deviceName).find(lower(select)) != std::string::npos;
}

VkInstance make_instance(const void* next, const std::vector<const char*>& layers,
                         const std::vector<const char*>& extensions) {
    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                        .pApplicationName = "vesper",
                                        .pEngineName = "vesper",
                                        .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                    .pNext = next,
                                    .pApplicationInfo = &application,
                                    .enabledLayerCount = uint32_t(layers.size()),
                                    .ppEnabledLayerNames = layers.data(),
                                    .enabledExtensionCount = uint32_t(extensions.size()),
                                    .ppEnabledExtensionNames = extensions.data()};
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = vkCreateInstance(&info, nullptr, &instance);
    if (result == VK_ERROR_LAYER_NOT_PRESENT)
        throw Error("validation was asked for, but its layer is missing: install vulkan-validationlayers");
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) throw Error(kInstall);
    check(result, "opening Vulkan");
    return instance;
}

std::string text_of(VkResult result) {
    switch (result) {
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return "out of memory";
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return "out of device memory";
        case VK_ERROR_INITIALIZATION_FAILED:
            return "initialization failed";
        case VK_ERROR_DEVICE_LOST:
            return "the device was lost";
        case VK_ERROR_MEMORY_MAP_FAILED:
            return "memory could not be mapped";
        case VK_ERROR_EXTENSION_NOT_PRESENT:
            return "an extension is missing";
        case VK_ERROR_SURFACE_LOST_KHR:
            return "the window was lost";
        case VK_ERROR_NATIVE_WINDOW_IN_USE_KHR:
            return "the window is in use";
        case VK_ERROR_FEATURE_NOT_PRESENT:
            return "a feature is missing";
        case VK_ERROR_FORMAT_NOT_SUPPORTED:
            return "a format is not supported";
        default:
            return "Vulkan result " + std::to_string(result);
    }
}

}  // namespace

void check(VkResult result, std::string_view what) {
    if (result == VK_SUCCESS) return;
    const std::string message = std::string(what) + ": " + text_of(result);
    if (result == VK_ERROR_DEVICE_LOST) throw DeviceLost(message);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY) throw OutOfDeviceMemory(message);
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY) throw OutOfHostMemory(message);
    throw Error(message);
}

std::vector<std::string> list_devices() {
    const struct Instance {
        VkInstance handle = make_instance(nullptr, {}, {});
        ~Instance() { vkDestroyInstance(handle, nullptr); }
    } instance;
    std::vector<std::string> lines;
    for (const VkPhysicalDevice device : physical_devices(instance.handle)) {
        const std::string reason = missing(device);
        lines.push_back(std::to_string(lines.size()) + ": " + described(device) +
                        (reason.empty() ? "" : " (unusable: " + reason + ")"));
    }
    return lines;
}

Device::Device(const DeviceOptions& options)
    : as_gpu_(options.as_gpu),
      as_least_(options.as_least),
      on_message_(options.on_message),
      presentation_(options.presentation) {
    try {
        open_instance(options.validation);
        const char* variable = std::getenv("VESPER_DEVICE");
        choose(!options.select.empty() ? options.select : variable ? variable : "");
        open_device();
    } catch (...) {
        close();
        throw;
    }
}

Device::Device(const BorrowedDevice& given)
    : borrowed_(true),
      instance_(given.instance),
      physical_(given.physical),
      device_(given.device),
      queue_(given.queue),
      queue_family_(given.queue_family),
      lock_(given.lock),
      unlock_(given.unlock) {
    vkGetPhysicalDeviceProperties(physical_, &properties_);
    std::string reason = missing_support(physical_);
    if (reason.empty()) reason = missing_of(*given.created_with, given.version);
    if (!reason.empty()) throw Error(name() + ", as it was made, has no " + reason);
    const std::span<const VkDeviceQueueCreateInfo> queues(given.created_with->pQueueCreateInfos,
                                                          given.created_with->queueCreateInfoCount);
    if (!is_queue_family(physical_, queue_family_) ||
        std::none_of(queues.begin(), queues.end(),
                     [&](const VkDeviceQueueCreateInfo& q) { return q.queueFamilyIndex == queue_family_; }))
        throw Error(name() + ", as it was made, has no queue for graphics and compute of family " +
                    std::to_string(queue_family_));
    learn(filters_along(*given.created_with), pushes_descriptors(*given.created_with));
}

Device::~Device() { close(); }

void Device::close() noexcept {
    once_.reset();
    if (borrowed_) return;
    if (device_) vkDestroyDevice(device_, nullptr);
    if (messenger_)
        if (const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
                vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT")))
            destroy(instance_, messenger_, nullptr);
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

std::optional<uint32_t> Device::queue_family(VkPhysicalDevice device) const {
    if (!presentation_) return graphics_queue_family(device);
    return graphics_queue_family(device,
                                 [&](uint32_t family) { return presentation_->possible(instance_, device, family); });
}

std::string Device::missing(VkPhysicalDevice device) const {
    std::string reason = gpu::missing(device);
    if (!reason.empty() || !presentation_) return reason;
    if (!has_extension(device, VK_KHR_SWAPCHAIN_EXTENSION_NAME)) return "no VK_KHR_swapchain";
    return queue_family(device) ? "" : "cannot show pictures in this window system";
}

void Device::open_instance(bool validation) {
    std::vector<const char*> extensions;
    if (presentation_) {
        for (const std::string& name : presentation_->instance_extensions) extensions.push_back(name.c_str());
        if (has_instance_extension(VK_EXT_SWAPCHAIN_COLOR_SPACE_EXTENSION_NAME))
            extensions.push_back(VK_EXT_SWAPCHAIN_COLOR_SPACE_EXTENSION_NAME);
    }
    if (!validation) {
        instance_ = make_instance(nullptr, {}, extensions);
        return;
    }
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    const VkDebugUtilsMessengerCreateInfoEXT messages{
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = forward_message,
        .pUserData = &on_message_};
    const VkValidationFeatureEnableEXT enable[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                           .pNext = &messages,
                                           .enabledValidationFeatureCount = 1,
                                           .pEnabledValidationFeatures = enable};
    instance_ = make_instance(&features, {kValidationLayer}, extensions);
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    if (create) check(create(instance_, &messages, nullptr, &messenger_), "listening to validation");
}

void Device::choose(const std::string& select) {
    std::string refused;
    int best = 4;
    const auto devices = physical_devices(instance_);
    if (devices.empty()) throw Error(kInstall);
    for (size_t i = 0; i < devices.size(); ++i) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        std::string reason = missing(devices[i]);
        if (reason.empty() && !matches(select, i, properties)) reason = "not '" + select + "'";
        if (!reason.empty()) {
            refused +=
                (refused.empty() ? "" : "; ") + std::to_string(i) + ": " + properties.deviceName + " (" + reason + ")";
        } else if (rank(properties.deviceType) < best) {
            best = rank(properties.deviceType);
            physical_ = devices[i];
            properties_ = properties;
        }
    }
    if (!physical_) throw Error("no usable Vulkan device: " + refused);
}

void Device::learn(bool filters_along, bool pushes_descriptors) {
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
    VkPhysicalDeviceSubgroupProperties subgroup{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &subgroup};
    vkGetPhysicalDeviceProperties2(physical_, &properties);
    subgroup_size_ = subgroup.subgroupSize;
    if (as_least_) properties_.limits.maxTexelBufferElements = kLeastTexelBuffer;
    driver_ = driver_of(physical_);
    uint32_t families = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical_, &families, nullptr);
    std::vector<VkQueueFamilyProperties> queues(families);
    vkGetPhysicalDeviceQueueFamilyProperties(physical_, &families, queues.data());
    const uint32_t bits = queues.at(queue_family_).timestampValidBits;
    timestamp_mask_ = bits >= 64 ? ~uint64_t{0} : (uint64_t{1} << bits) - 1;
    // Filtering along eight samples costs a CPU device 130 ms a frame; it goes without.
    has_anisotropy_ = filters_along && !is_cpu();
    if (!pushes_descriptors) return;
    push_descriptors =
        reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(vkGetDeviceProcAddr(device_, "vkCmdPushDescriptorSetKHR"));
}

void Device::open_device() {
    queue_family_ = *queue_family(physical_);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .queueFamilyIndex = queue_family_,
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
    VkPhysicalDeviceVulkan13Features f13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features f12{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &f13};
    VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &f12};
    enable_features(physical_, features);
    std::vector<const char*> extensions;
    for (const char* extension : kDeviceExtensions)
        if (!as_least_ && has_extension(physical_, extension)) extensions.push_back(extension);
    if (presentation_) {
        extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
        has_hdr_metadata_ = has_extension(physical_, VK_EXT_HDR_METADATA_EXTENSION_NAME);
        if (has_hdr_metadata_) extensions.push_back(VK_EXT_HDR_METADATA_EXTENSION_NAME);
    }
    const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                  .pNext = &features,
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue,
                                  .enabledExtensionCount = uint32_t(extensions.size()),
                                  .ppEnabledExtensionNames = extensions.data()};
    check(vkCreateDevice(physical_, &info, nullptr, &device_), "opening " + name());
    vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
    learn(features.features.samplerAnisotropy, pushes_descriptors(info));
}

bool Device::has_long_texel_buffers() const { return limits().maxTexelBufferElements >= kLongTexelBuffer; }

uint64_t Device::most_texels(uint64_t bytes) const {
    return has_long_texel_buffers() ? limits().maxTexelBufferElements : limits().maxStorageBufferRange / bytes;
}

uint32_t Device::memory_type(uint32_t allowed, VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred) const {
    for (const VkMemoryPropertyFlags wanted : {required | preferred, required})
        for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
            if ((allowed >> i & 1) && (memory_.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    throw Error(name() + ": no memory of the kind a resource needs");
}

bool Device::is_coherent(uint32_t memory_type) const {
    return memory_.memoryTypes[memory_type].propertyFlags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
}

void Device::run_once(const std::function<void(VkCommandBuffer)>& record) const {
    if (!once_) once_ = std::make_unique<CommandBuffer>(*this, VK_COMMAND_POOL_CREATE_TRANSIENT_BIT);
    const CommandBuffer& commands = *once_;
    commands.begin();
    record(commands);
    // The wait below does not make what was written visible to later commands.
    pipeline_barrier(commands, {}, &kWholeBarrier);
    check(vkEndCommandBuffer(commands), "recording");
    const VkCommandBufferSubmitInfo submitted{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                              .commandBuffer = commands};
    const VkSubmitInfo2 submit{
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &submitted};
    const OwnedFence done = make_fence(*this);
    this->submit(submit, done.get(), "submitting");
    wait(done.get());
}

void Device::submit(const VkSubmitInfo2& work, VkFence fence, std::string_view what) const {
    if (lock_) lock_();
    const VkResult result = vkQueueSubmit2(queue_, 1, &work, fence);
    if (unlock_) unlock_();
    check(result, what);
    ++use_.submissions;
}

void Device::wait(VkFence fence) const {
    ++use_.waits;
    const VkResult waited = vkWaitForFences(device_, 1, &fence, VK_TRUE, UINT64_MAX);
    if (waited != VK_SUCCESS) settle(fence);  // what was submitted uses what goes now
    check(waited, "waiting for the device");
}

void Device::settle(VkFence fence) const noexcept {
    // A lost device does nothing any more. Without memory for waiting there may be some a little later; a borrowed
    // device has other queues, at which others may be, so that it cannot be waited for as a whole.
    for (int tries = 0; tries < 1000; ++tries) {
        const VkResult waited = vkWaitForFences(device_, 1, &fence, VK_TRUE, UINT64_MAX);
        if (waited == VK_SUCCESS || waited == VK_ERROR_DEVICE_LOST) return;
        if (!borrowed_ && vkDeviceWaitIdle(device_) == VK_SUCCESS) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

OwnedFence make_fence(const Device& device, VkFenceCreateFlags flags) {
    const VkFenceCreateInfo info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, .flags = flags};
    VkFence fence = VK_NULL_HANDLE;
    check(vkCreateFence(device.handle(), &info, nullptr, &fence), "making a fence");
    return {device.handle(), fence};
}

}  // namespace vesper::gpu
