#include "window/swapchain.h"

#include <algorithm>
#include <optional>

namespace vesper::window {
namespace {

using gpu::check;

/// How long a hidden window is waited for, ns, before the program looks after its other work.
constexpr uint64_t kPatience = 200'000'000;

std::optional<VkSurfaceFormatKHR> format_for(const std::vector<VkSurfaceFormatKHR>& offered, WindowCodes codes) {
    const VkColorSpaceKHR space =
        codes == WindowCodes::Hdr10 ? VK_COLOR_SPACE_HDR10_ST2084_EXT : VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    const auto wanted =
        codes == WindowCodes::Sdr8
            ? std::array{VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_A8B8G8R8_UNORM_PACK32}
            : std::array{VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_FORMAT_A2R10G10B10_UNORM_PACK32, VK_FORMAT_UNDEFINED};
    for (const VkFormat format : wanted)
        for (const VkSurfaceFormatKHR& o : offered)
            if (o.format == format && o.colorSpace == space) return o;
    return std::nullopt;
}

VkPresentModeKHR mode_for(const std::vector<VkPresentModeKHR>& offered, Vsync vsync) {
    const auto has = [&](VkPresentModeKHR mode) {
        return std::find(offered.begin(), offered.end(), mode) != offered.end();
    };
    if (vsync == Vsync::Off && has(VK_PRESENT_MODE_IMMEDIATE_KHR)) return VK_PRESENT_MODE_IMMEDIATE_KHR;
    if (vsync != Vsync::Wait && has(VK_PRESENT_MODE_MAILBOX_KHR)) return VK_PRESENT_MODE_MAILBOX_KHR;
    return VK_PRESENT_MODE_FIFO_KHR;  // always there
}

const char* name_of(WindowCodes codes) {
    return codes == WindowCodes::Sdr8 ? "8 bits" : codes == WindowCodes::Sdr10 ? "10 bits" : "HDR10";
}

gpu::Owned<VkSemaphore, vkDestroySemaphore> make_semaphore(VkDevice device) {
    const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    check(vkCreateSemaphore(device, &info, nullptr, &semaphore), "making a semaphore");
    return {device, semaphore};
}

void change_layout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to, VkAccessFlags2 before,
                   VkAccessFlags2 after) {
    constexpr VkPipelineStageFlags2 drawing = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkImageMemoryBarrier2 barrier = gpu::image_barrier(image, {drawing, before}, {drawing, after}, from, to);
    gpu::pipeline_barrier(commands, {&barrier, 1});
}

}  // namespace

Swapchain::Swapchain(gpu::Device& device, MakeSurface make_surface)
    : device_(device), make_surface_(std::move(make_surface)) {
    open_surface();
    for (Slot& slot : slots_) {
        slot.commands = gpu::CommandBuffer(device_);
        slot.done = gpu::make_fence(device_, VK_FENCE_CREATE_SIGNALED_BIT);
        slot.acquired = make_semaphore(device_.handle());
    }
}

Swapchain::~Swapchain() { close_surface(); }

void Swapchain::open_surface() {
    surface_ = make_surface_(device_.instance());
    const VkPhysicalDevice physical = device_.physical();
    VkBool32 supported = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(physical, device_.queue_family(), surface_, &supported),
          "asking for a window's device");
    if (!supported) throw Error(device_.name() + " cannot show pictures in this window");
    uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface_, &count, nullptr), "asking for a window's formats");
    formats_.resize(count);
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface_, &count, formats_.data()),
          "asking for a window's formats");
    check(vkGetPhysicalDeviceSurfacePresentModesKHR(physical, surface_, &count, nullptr),
          "asking how a window shows pictures");
    modes_.resize(count);
    check(vkGetPhysicalDeviceSurfacePresentModesKHR(physical, surface_, &count, modes_.data()),
          "asking how a window shows pictures");
    stale_ = true;
}

void Swapchain::close_surface() noexcept {
    vkQueueWaitIdle(device_.queue());  // whatever it says: everything goes
    images_.clear();
    swapchain_ = {};
    if (surface_) vkDestroySurfaceKHR(device_.instance(), surface_, nullptr);
    surface_ = VK_NULL_HANDLE;
}

bool Swapchain::offers(WindowCodes codes) const { return format_for(formats_, codes).has_value(); }

bool Swapchain::rebuild(const SwapchainSettings& settings) {
    VkSurfaceCapabilitiesKHR able;
    const VkResult asked = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_, &able);
    if (asked == VK_ERROR_SURFACE_LOST_KHR) {
        close_surface();
        open_surface();
        return false;
    }
    check(asked, "asking for a window's size");
    VkExtent2D extent = able.currentExtent;
    if (extent.width == ~0u)
        extent = {std::clamp(settings.extent.width, able.minImageExtent.width, able.maxImageExtent.width),
                  std::clamp(settings.extent.height, able.minImageExtent.height, able.maxImageExtent.height)};
    if (extent.width == 0 || extent.height == 0 || settings.extent.width == 0 || settings.extent.height == 0)
        return false;
    const auto format = format_for(formats_, settings.codes);
    if (!format) throw Error("this window does not show codes of " + std::string(name_of(settings.codes)));

    check(vkQueueWaitIdle(device_.queue()), "waiting for the device");
    images_.clear();
    const uint32_t most = able.maxImageCount ? able.maxImageCount : ~0u;
    const VkPresentModeKHR mode = mode_for(modes_, settings.vsync);
    const VkCompositeAlphaFlagBitsKHR alpha = able.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                                  ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                                  : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    const VkSwapchainCreateInfoKHR info{.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                        .surface = surface_,
                                        .minImageCount = std::min(able.minImageCount + 1, most),
                                        .imageFormat = format->format,
                                        .imageColorSpace = format->colorSpace,
                                        .imageExtent = extent,
                                        .imageArrayLayers = 1,
                                        .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                        .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
                                        .preTransform = able.currentTransform,
                                        .compositeAlpha = alpha,
                                        .presentMode = mode,
                                        .clipped = VK_TRUE,
                                        .oldSwapchain = swapchain_.get()};
    VkSwapchainKHR raw = VK_NULL_HANDLE;
    const VkResult made = vkCreateSwapchainKHR(device_.handle(), &info, nullptr, &raw);
    swapchain_ = {device_.handle(), raw};
    if (made == VK_ERROR_SURFACE_LOST_KHR) {
        close_surface();
        open_surface();
        return false;
    }
    check(made, "making the images of a window");

    uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(device_.handle(), raw, &count, nullptr), "getting the images of a window");
    std::vector<VkImage> images(count);
    check(vkGetSwapchainImagesKHR(device_.handle(), raw, &count, images.data()), "getting the images of a window");
    for (const VkImage image : images) {
        const VkImageViewCreateInfo view_info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                              .image = image,
                                              .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                              .format = format->format,
                                              .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
        VkImageView view = VK_NULL_HANDLE;
        check(vkCreateImageView(device_.handle(), &view_info, nullptr, &view), "viewing an image of a window");
        images_.push_back({image, {device_.handle(), view}, make_semaphore(device_.handle())});
    }
    extent_ = extent, format_ = *format, mode_ = mode, built_for_ = settings, stale_ = false;
    if (settings.codes == WindowCodes::Hdr10) describe_light(settings);
    return true;
}

void Swapchain::describe_light(const SwapchainSettings& settings) const {
    if (!device_.has_hdr_metadata()) return;
    const auto set =
        reinterpret_cast<PFN_vkSetHdrMetadataEXT>(vkGetDeviceProcAddr(device_.handle(), "vkSetHdrMetadataEXT"));
    const VkHdrMetadataEXT light{.sType = VK_STRUCTURE_TYPE_HDR_METADATA_EXT,
                                 .displayPrimaryRed = {0.708f, 0.292f},  // Rec. 2020
                                 .displayPrimaryGreen = {0.170f, 0.797f},
                                 .displayPrimaryBlue = {0.131f, 0.046f},
                                 .whitePoint = {0.3127f, 0.3290f},
                                 .maxLuminance = settings.peak,
                                 .minLuminance = settings.black,
                                 .maxContentLightLevel = settings.peak,
                                 .maxFrameAverageLightLevel = settings.peak};
    const VkSwapchainKHR swapchain = swapchain_.get();
    if (set) set(device_.handle(), 1, &swapchain, &light);
}

bool Swapchain::show(const SwapchainSettings& settings, const Draw& draw) {
    const SwapchainSettings& b = built_for_;
    if (stale_ || settings.extent.width != b.extent.width || settings.extent.height != b.extent.height ||
        settings.vsync != b.vsync || settings.codes != b.codes || settings.peak != b.peak || settings.black != b.black)
        if (!rebuild(settings)) return false;

    Slot& slot = slots_[next_slot_];
    const VkFence done = slot.done.get();
    check(vkWaitForFences(device_.handle(), 1, &done, VK_TRUE, UINT64_MAX), "waiting for a frame");
    uint32_t image = 0;
    const VkResult acquired = vkAcquireNextImageKHR(device_.handle(), swapchain_.get(), kPatience, slot.acquired.get(),
                                                    VK_NULL_HANDLE, &image);
    if (acquired == VK_TIMEOUT || acquired == VK_NOT_READY) return false;
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR || acquired == VK_ERROR_SURFACE_LOST_KHR) {
        stale_ = true;
        return false;
    }
    if (acquired != VK_SUBOPTIMAL_KHR) check(acquired, "getting an image of a window");

    check(vkResetFences(device_.handle(), 1, &done), "waiting for a frame");
    record(slot, images_[image], draw, next_slot_);
    next_slot_ = (next_slot_ + 1) % kSlots;
    const VkResult presented = present(slot, image);
    stale_ = acquired == VK_SUBOPTIMAL_KHR || presented != VK_SUCCESS;
    if (presented == VK_ERROR_OUT_OF_DATE_KHR || presented == VK_ERROR_SURFACE_LOST_KHR) return false;
    if (presented != VK_SUBOPTIMAL_KHR) check(presented, "showing a picture");
    return true;
}

void Swapchain::record(const Slot& slot, const Image& image, const Draw& draw, uint32_t index) const {
    slot.commands.begin();
    change_layout(slot.commands, image.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, 0,
                  VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT);
    draw(slot.commands,
         {image.view.get(), extent_, format_.format, format_.colorSpace == VK_COLOR_SPACE_HDR10_ST2084_EXT, index});
    change_layout(slot.commands, image.image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                  VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, 0);
    check(vkEndCommandBuffer(slot.commands), "recording");
}

VkResult Swapchain::present(const Slot& slot, uint32_t image) {
    const VkSemaphore drawn = images_[image].drawn.get();
    const VkSemaphoreSubmitInfo wait{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                     .semaphore = slot.acquired.get(),
                                     .stageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT};
    const VkSemaphoreSubmitInfo signal{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                       .semaphore = drawn,
                                       .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    const VkCommandBufferSubmitInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                             .commandBuffer = slot.commands};
    const VkSubmitInfo2 submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                               .waitSemaphoreInfoCount = 1,
                               .pWaitSemaphoreInfos = &wait,
                               .commandBufferInfoCount = 1,
                               .pCommandBufferInfos = &commands,
                               .signalSemaphoreInfoCount = 1,
                               .pSignalSemaphoreInfos = &signal};
    check(vkQueueSubmit2(device_.queue(), 1, &submit, slot.done.get()), "submitting a picture");
    const VkSwapchainKHR swapchain = swapchain_.get();
    const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                .waitSemaphoreCount = 1,
                                .pWaitSemaphores = &drawn,
                                .swapchainCount = 1,
                                .pSwapchains = &swapchain,
                                .pImageIndices = &image};
    return vkQueuePresentKHR(device_.queue(), &info);
}

std::string Swapchain::describe() const {
    const char* mode = mode_ == VK_PRESENT_MODE_IMMEDIATE_KHR ? "immediate"
                       : mode_ == VK_PRESENT_MODE_MAILBOX_KHR ? "mailbox"
                                                              : "fifo";
    return std::to_string(extent_.width) + "x" + std::to_string(extent_.height) + ", " + name_of(built_for_.codes) +
           ", " + mode;
}

}  // namespace vesper::window
