// Own device: a host that renders with Vulkan lets Vesper tone-map its images on its device and queue, without ever
// waiting, and goes on rendering when Vesper is gone. Every mistake that the validation layer hears of, the host's or
// Vesper's, fails it.
//     own_device OUT.ppm
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <memory>
#include <string_view>

#include <vesper/vulkan.h>
#include <vesper/vesper.hpp>

#include "host.h"

using namespace vesper::cpp;

namespace {

constexpr VkExtent2D kExtent{640, 400};
constexpr unsigned kFrames = 6;

// A night street as a renderer would leave it, in units of 100 cd/m^2: sky, road, and two rows of lamps that pass by.
void draw_street(VkCommandBuffer commands, const Image& hdr, unsigned frame) {
    change_layout(commands, hdr.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    VkRenderingAttachmentInfo target{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    target.imageView = hdr.view, target.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    target.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR, target.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    target.clearValue.color = {{1e-4f, 1.5e-4f, 3e-4f, 1}};
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea.extent = kExtent, rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1, rendering.pColorAttachments = &target;
    vkCmdBeginRendering(commands, &rendering);
    const auto fill = [&](VkRect2D area, VkClearColorValue light) {
        const VkClearAttachment what{VK_IMAGE_ASPECT_COLOR_BIT, 0, {light}};
        const VkClearRect where{area, 0, 1};
        vkCmdClearAttachments(commands, 1, &what, 1, &where);
    };
    for (unsigned strip = 0; strip < 8; ++strip) {  // brighter where it is nearer
        const float light = 2e-3f + 1e-3f * float(strip);
        fill({{0, int32_t(200 + 25 * strip)}, {kExtent.width, 25}}, {{light, 0.9f * light, 0.7f * light, 1}});
    }
    for (unsigned lamp = 1; lamp < 6; ++lamp) {
        const uint32_t size = 2 + 2 * lamp, away = 20 + 42 * lamp + 4 * frame;
        for (const uint32_t x : {kExtent.width / 2 - away, kExtent.width / 2 + away})
            fill({{int32_t(x), int32_t(190 - 25 * lamp)}, {size, size / 2}}, {{60, 45, 20, 1}});
    }
    vkCmdEndRendering(commands);
    change_layout(commands, hdr.image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

uint32_t graphics_family(VkPhysicalDevice device) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    for (uint32_t i = 0; i < count; ++i)
        if ((families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) && (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT))
            return i;
    throw std::runtime_error("no queue for graphics and compute");
}

void write_picture(const char* name, const std::vector<uint8_t>& rgba) {
    std::FILE* file = std::fopen(name, "wb");
    if (!file) throw std::runtime_error(std::string(name) + ": cannot be written");
    std::fprintf(file, "P6\n%u %u\n255\n", kExtent.width, kExtent.height);
    for (size_t i = 0; i < rgba.size(); i += 4) std::fwrite(&rgba[i], 1, 3, file);
    if (std::fclose(file)) throw std::runtime_error(std::string(name) + ": cannot be written");
}

void run(const Instance& instance, const char* out) {
    // The host's device: what the host wants (timeline semaphores), and what Vesper needs.
    const VkPhysicalDevice physical = instance.first_device();
    const uint32_t family = graphics_family(physical);
    VkPhysicalDeviceVulkan13Features f13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features f12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &f13};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &f12, {}};
    f12.timelineSemaphore = VK_TRUE;
    call(vesper_device_features, physical, &features);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue_info{
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, family, 1, &priority};
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
    info.queueCreateInfoCount = 1, info.pQueueCreateInfos = &queue_info;
    uint32_t used = 0;
    const char* const* names = vesper_device_extensions(&used);
    const std::vector<const char*> extensions = extensions_of(physical, names, used);
    info.enabledExtensionCount = uint32_t(extensions.size()), info.ppEnabledExtensionNames = extensions.data();
    VkDevice device = VK_NULL_HANDLE;
    check(vkCreateDevice(physical, &info, nullptr, &device), "opening the device");
    VkQueue queue = VK_NULL_HANDLE;
    vkGetDeviceQueue(device, family, 0, &queue);
    const std::unique_ptr<VkDevice_T, void (*)(VkDevice)> closes(
        device, [](VkDevice opened) { vkDestroyDevice(opened, nullptr); });

    Host host(physical, device, queue, family);
    Image hdr = host.make_image(VK_FORMAT_R16G16B16A16_SFLOAT, kExtent,
                                VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    Image shown = host.make_image(VK_FORMAT_R8G8B8A8_SRGB, kExtent,
                                  VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);

    // Lent to Vesper.
    auto lent = sized<VesperHostDevice>();
    lent.api_version = VK_API_VERSION_1_3;
    lent.instance = instance.get(), lent.physical_device = physical, lent.device = device, lent.created_with = &info;
    lent.queue = queue, lent.queue_family = family;
    Device device_of_vesper = make<Device>(vesper_device_borrow, &lent);
    ToneMapper mapper = make<ToneMapper>(vesper_tone_mapper_create, device_of_vesper.get());

    auto from = sized<VesperImage>();
    from.image = hdr.image, from.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    from.width = kExtent.width, from.height = kExtent.height;
    from.layout_before = from.layout_after = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    VesperImage to = from;
    to.image = shown.image, to.format = VK_FORMAT_R8G8B8A8_SRGB;
    to.layout_before = VK_IMAGE_LAYOUT_UNDEFINED, to.layout_after = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    auto picture = sized<VesperImagePicture>();
    picture.image = &from, picture.scale = 100, picture.vertical_fov = 0.7f;
    VesperToneSettings settings = default_tone_settings();
    settings.glare = VESPER_GLARE_CIE;

    // Frames: the timeline is at 2 i + 1 when the host's part of frame i is done, and at 2 i + 2 when Vesper's is. On
    // one queue that is not needed; another, such as one that presents, would wait for it.
    uint64_t time = 0;
    for (unsigned frame = 0; frame < kFrames; ++frame) {
        host.submit([&](VkCommandBuffer commands) { draw_street(commands, hdr, frame); }, ++time);
        VkSemaphoreSubmitInfo drawn{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
        drawn.semaphore = host.timeline(), drawn.value = time, drawn.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        VkSemaphoreSubmitInfo mapped = drawn;
        mapped.value = ++time;
        auto handover = sized<VesperHandover>();
        handover.wait_count = handover.signal_count = 1, handover.waits = &drawn, handover.signals = &mapped;
        call(vesper_tone_map_image, mapper.get(), &settings, &picture, 1 / 60.0f, &to, &handover);
    }
    auto report = sized<VesperFrameReport>();
    call(vesper_tone_mapper_finish, mapper.get(), &report);
    std::printf("%u frames on %s: the eye is adapted to %.3g cd/m^2\n", kFrames,
                vesper_device_name(device_of_vesper.get()), report.adaptation);
    write_picture(out, host.read(shown, kExtent, ++time));

    // Vesper goes, the host goes on.
    mapper.reset(), device_of_vesper.reset();
    host.submit([&](VkCommandBuffer commands) { draw_street(commands, hdr, kFrames); }, ++time);
    host.wait(time);
    host.destroy(hdr), host.destroy(shown);
}

}  // namespace

int main(int count, char** arguments) {
    const std::string_view argument = count == 2 ? arguments[1] : "";
    if (argument == "--help" || argument == "-h") {
        std::printf(
            "Renders six frames of a street on a Vulkan device of its own, lets Vesper tone-map them there, and writes "
            "the last.\n"
            "Usage: own_device OUT.ppm\n"
            "\n"
            "  OUT.ppm    the picture, %u x %u px\n"
            "  -h,--help  this text\n"
            "\n"
            "The device is the first of Vulkan's list. Prints the eye's adaptation luminance, and whether the "
            "validation layer,\n"
            "where it is installed, complained.\n"
            "Ends with 0, 1 if something failed or the layer complained, 2 without a file to write.\n",
            kExtent.width, kExtent.height);
        return 0;
    }
    if (argument.empty() || argument.front() == '-') {
        std::fprintf(stderr, "own_device: one file to write is expected (own_device --help)\n");
        return 2;
    }
    try {
        const Instance instance;
        run(instance, arguments[1]);
        std::printf("validation: %s\n", !instance.validated() ? "not installed"
                                        : instance.messages() ? "has complaints"
                                                              : "silent");
        return instance.messages() ? 1 : 0;
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "own_device: %s\n", failure.what());
        return 1;
    }
}
