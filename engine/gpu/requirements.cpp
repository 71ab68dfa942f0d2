#include "gpu/requirements.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "base/error.h"

namespace vesper::gpu {
namespace {

/// Where a feature is in a structure.
struct FeatureField {
    VkStructureType type;
    size_t offset;
};
/// A feature by its name in Vulkan, and the structures it may be in: of a version, and of the extension that became
/// part of that.
struct Feature {
    const char* name;
    std::array<FeatureField, 2> fields;
};

constexpr FeatureField in_core(size_t offset) {
    return {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, offsetof(VkPhysicalDeviceFeatures2, features) + offset};
}

constexpr FeatureField kIndependentBlend = in_core(offsetof(VkPhysicalDeviceFeatures, independentBlend));
constexpr FeatureField kClipDistance = in_core(offsetof(VkPhysicalDeviceFeatures, shaderClipDistance));
constexpr FeatureField kFragmentStores = in_core(offsetof(VkPhysicalDeviceFeatures, fragmentStoresAndAtomics));
constexpr FeatureField kAnisotropy = in_core(offsetof(VkPhysicalDeviceFeatures, samplerAnisotropy));
constexpr VkStructureType k12 = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                          k13 = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;

// Of a shader stage: shade.comp takes 15 storage buffers where its texels are in them, cull_triangles.comp 7 where they
// are not; acuity.comp takes 8 images. Histograms are made by workgroups of a thread for each bin.
constexpr uint32_t kStorageBuffers = 16, kFewStorageBuffers = 7, kStorageImages = 8, kColourTargets = 5,
                   kInvocations = 256;

constexpr Feature kFeatures[] = {
    {"independentBlend", {kIndependentBlend, kIndependentBlend}},
    {"shaderClipDistance", {kClipDistance, kClipDistance}},
    {"fragmentStoresAndAtomics", {kFragmentStores, kFragmentStores}},
    {"scalarBlockLayout",
     {{{k12, offsetof(VkPhysicalDeviceVulkan12Features, scalarBlockLayout)},
       {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES,
        offsetof(VkPhysicalDeviceScalarBlockLayoutFeatures, scalarBlockLayout)}}}},
    {"dynamicRendering",
     {{{k13, offsetof(VkPhysicalDeviceVulkan13Features, dynamicRendering)},
       {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES,
        offsetof(VkPhysicalDeviceDynamicRenderingFeatures, dynamicRendering)}}}},
    {"synchronization2",
     {{{k13, offsetof(VkPhysicalDeviceVulkan13Features, synchronization2)},
       {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES,
        offsetof(VkPhysicalDeviceSynchronization2Features, synchronization2)}}}},
    {"maintenance4",
     {{{k13, offsetof(VkPhysicalDeviceVulkan13Features, maintenance4)},
       {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES,
        offsetof(VkPhysicalDeviceMaintenance4Features, maintenance4)}}}},
};

/// Where a chain of structures has one of these, or null.
VkBool32* find(void* chain, std::span<const FeatureField> fields) {
    for (auto* at = static_cast<VkBaseOutStructure*>(chain); at; at = at->pNext)
        for (const FeatureField& home : fields)
            if (at->sType == home.type)
                return reinterpret_cast<VkBool32*>(reinterpret_cast<std::byte*>(at) + home.offset);
    return nullptr;
}

void list(std::string& names, const std::string& name) { names += (names.empty() ? "" : ", ") + name; }

std::string missing_features(void* chain) {
    std::string names;
    for (const Feature& feature : kFeatures)
        if (const VkBool32* on = find(chain, feature.fields); !on || !*on) list(names, feature.name);
    return names;
}

/// What a device was made with: core features may be given in either of two ways.
class MadeWith {
public:
    explicit MadeWith(const VkDeviceCreateInfo& info) : chain_(const_cast<void*>(info.pNext)) {
        if (!info.pEnabledFeatures) return;
        core_.pNext = chain_, core_.features = *info.pEnabledFeatures;
        chain_ = &core_;
    }
    MadeWith(const MadeWith&) = delete;
    void* chain() const { return chain_; }  // read only

private:
    VkPhysicalDeviceFeatures2 core_{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    void* chain_;
};

std::string version_text(uint32_t version) {
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version));
}

std::string kind_of(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return "discrete GPU";
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return "integrated GPU";
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return "virtual GPU";
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return "CPU";
        default:
            return "other device";
    }
}

}  // namespace

std::string missing_support(VkPhysicalDevice device) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(device, &properties);
    if (properties.apiVersion < kVulkanVersion) return "Vulkan " + version_text(kVulkanVersion);
    VkPhysicalDeviceVulkan13Features f13{.sType = k13};
    VkPhysicalDeviceVulkan12Features f12{.sType = k12, .pNext = &f13};
    VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &f12};
    vkGetPhysicalDeviceFeatures2(device, &features);
    std::string names = missing_features(&features);
    VkPhysicalDeviceSubgroupProperties subgroup{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceProperties2 more{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &subgroup};
    vkGetPhysicalDeviceProperties2(device, &more);
    if (!(subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) ||
        !(subgroup.supportedOperations & VK_SUBGROUP_FEATURE_VOTE_BIT) ||
        !(subgroup.supportedOperations & VK_SUBGROUP_FEATURE_ARITHMETIC_BIT))
        list(names, "subgroups with votes and arithmetic in compute shaders");
    const VkPhysicalDeviceLimits& limits = properties.limits;
    if (limits.maxPerStageDescriptorStorageBuffers < kFewStorageBuffers)
        list(names, std::to_string(kFewStorageBuffers) + " storage buffers per shader stage");
    else if (limits.maxTexelBufferElements < kLongTexelBuffer &&
             limits.maxPerStageDescriptorStorageBuffers < kStorageBuffers)
        list(names, "texel buffers of " + std::to_string(kLongTexelBuffer) + " elements or " +
                        std::to_string(kStorageBuffers) + " storage buffers per shader stage");
    if (limits.maxPerStageDescriptorStorageImages < kStorageImages)
        list(names, std::to_string(kStorageImages) + " storage images per shader stage");
    if (std::min({limits.maxColorAttachments, limits.maxFragmentOutputAttachments,
                  limits.maxFragmentCombinedOutputResources}) < kColourTargets)
        list(names, std::to_string(kColourTargets) + " colour attachments");
    if (limits.maxComputeWorkGroupInvocations < kInvocations || limits.maxComputeWorkGroupSize[0] < kInvocations)
        list(names, "workgroups of " + std::to_string(kInvocations) + " invocations");
    uint32_t families = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &families, nullptr);
    uint32_t family = 0;
    while (family < families && !is_queue_family(device, family)) ++family;
    if (family == families) list(names, "a queue for graphics and compute");
    return names;
}

std::string missing_of(const VkDeviceCreateInfo& info, uint32_t version) {
    std::string names;
    if (version < kVulkanVersion)
        list(names,
             "Vulkan " + version_text(kVulkanVersion) + " (its instance was made for " + version_text(version) + ")");
    if (const std::string features = missing_features(MadeWith(info).chain()); !features.empty()) list(names, features);
    return names;
}

void enable_features(VkPhysicalDevice device, VkPhysicalDeviceFeatures2& chain) {
    std::string homeless;
    for (const Feature& feature : kFeatures)
        if (!find(&chain, feature.fields)) list(homeless, feature.name);
    if (!homeless.empty()) throw Error("the chain of features has no structure for " + homeless);
    for (const Feature& feature : kFeatures) *find(&chain, feature.fields) = VK_TRUE;
    VkPhysicalDeviceFeatures available;
    vkGetPhysicalDeviceFeatures(device, &available);
    chain.features.samplerAnisotropy |= available.samplerAnisotropy;
}

bool filters_along(const VkDeviceCreateInfo& info) {
    const MadeWith made(info);
    const VkBool32* on = find(made.chain(), {&kAnisotropy, 1});
    return on && *on;
}

bool pushes_descriptors(const VkDeviceCreateInfo& info) {
    const std::span<const char* const> enabled(info.ppEnabledExtensionNames, info.enabledExtensionCount);
    return std::ranges::any_of(
        enabled, [](const char* name) { return std::strcmp(name, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME) == 0; });
}

bool has_extension(VkPhysicalDevice device, const char* name) {
    uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> all(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, all.data());
    return std::any_of(all.begin(), all.end(), [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

bool is_queue_family(VkPhysicalDevice device, uint32_t family) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    constexpr VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    return family < count && (families[family].queueFlags & wanted) == wanted;
}

std::string driver_of(VkPhysicalDevice device) {
    VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    vkGetPhysicalDeviceProperties2(device, &properties);
    return std::string(driver.driverName) + " " + driver.driverInfo;
}

std::string described(VkPhysicalDevice device) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(device, &properties);
    const uint32_t version = properties.apiVersion;
    std::string text = std::string(properties.deviceName) + " (" + kind_of(properties.deviceType) + ", Vulkan " +
                       version_text(version) + "." + std::to_string(VK_API_VERSION_PATCH(version));
    if (version >= VK_API_VERSION_1_2) text += ", " + driver_of(device);
    return text + ")";
}

}  // namespace vesper::gpu
