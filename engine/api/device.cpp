// Devices, of Vesper's own and of the host's. SPDX-License-Identifier: MIT
#include "api/handles.h"
#include "gpu/requirements.h"

namespace vesper::api {

extern "C" {

void vesper_version(uint32_t version[3]) {
    constexpr uint32_t parts[3]{VESPER_VERSION_MAJOR, VESPER_VERSION_MINOR, VESPER_VERSION_PATCH};
    if (version) std::copy(parts, parts + 3, version);
}

VesperResult vesper_device_open(const VesperDeviceOptions* options, VesperDevice** device, VesperError* error) {
    return guarded(error, [&] {
        require(device, "the pointer to the device is null");
        const VesperDeviceOptions o =
            options ? known(options, "device options without their size") : VesperDeviceOptions{};
        gpu::DeviceOptions opened{
            .select = o.select ? o.select : "", .validation = o.validation != 0, .on_message = {}};
        if (o.on_message)
            opened.on_message = [call = o.on_message, user = o.user](const std::string& message) {
                call(message.c_str(), user);
            };
        *device = new VesperDevice(opened);
    });
}
void vesper_device_close(VesperDevice* device) { delete device; }
const char* vesper_device_name(const VesperDevice* device) { return device ? device->name.c_str() : ""; }

const char* const* vesper_device_extensions(uint32_t* count) {
    if (count) *count = uint32_t(gpu::kDeviceExtensions.size());
    return gpu::kDeviceExtensions.data();
}

VesperResult vesper_device_features(VkPhysicalDevice physical_device, VkPhysicalDeviceFeatures2* features,
                                    VesperError* error) {
    return guarded(error, [&] {
        require(physical_device && features && features->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                "no physical device, or no features to set");
        const std::string missing = gpu::missing_support(physical_device);
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(physical_device, &properties);
        if (!missing.empty()) throw Error(std::string(properties.deviceName) + " has no " + missing);
        gpu::enable_features(physical_device, *features);
    });
}

VesperResult vesper_device_borrow(const VesperHostDevice* host, VesperDevice** device, VesperError* error) {
    return guarded(error, [&] {
        require(device, "the pointer to the device is null");
        const VesperHostDevice h = known(host, "a device of the host's without its size");
        require(h.instance && h.physical_device && h.device && h.queue,
                "a device of the host's has an instance, a physical device, a device and a queue");
        require(h.created_with && h.created_with->sType == VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                "what the device was made with is missing");
        require(!h.lock_queue == !h.unlock_queue, "a queue is locked and unlocked, or neither");
        gpu::BorrowedDevice given{h.instance,    h.physical_device, h.device, h.queue, h.queue_family,
                                  h.api_version, h.created_with,    {},       {}};
        if (h.lock_queue) {
            given.lock = [call = h.lock_queue, user = h.user] { call(user); };
            given.unlock = [call = h.unlock_queue, user = h.user] { call(user); };
        }
        *device = new VesperDevice(given);
    });
}

}  // extern "C"

}  // namespace vesper::api
