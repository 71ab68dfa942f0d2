// Pictures in a window: its images, when they are shown, and what happens when it changes. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "gpu/commands.h"

namespace vesper::window {

/// When a finished picture replaces the one that is shown.
enum class Vsync : uint8_t {
    Wait,    ///< at the next refresh, each in its turn (FIFO)
    Latest,  ///< at the next refresh, the newest (mailbox); where that is not offered, as Wait
    Off,     ///< at once, which may tear (immediate); where that is not offered, as Latest
};

/// What the codes of a window mean. They are shown unchanged: nothing encodes them again.
enum class WindowCodes : uint8_t {
    Sdr8,   ///< 8 bits, as the display has them
    Sdr10,  ///< 10 bits, likewise
    Hdr10,  ///< 10 bits of SMPTE ST 2084 in Rec. 2020, absolute
};

struct SwapchainSettings {
    VkExtent2D extent{};  ///< of the window, px, for window systems that leave it to the program
    Vsync vsync = Vsync::Wait;
    WindowCodes codes = WindowCodes::Sdr8;
    float peak = 1000, black = 0.005f;  ///< cd/m^2: told to a HDR10 display, which may fit what it shows to that
};

/// An image of the window, to draw into.
struct WindowImage {
    VkImageView view = VK_NULL_HANDLE;
    VkExtent2D extent{};
    VkFormat format = VK_FORMAT_UNDEFINED;
    bool hdr10 = false;
    uint32_t slot = 0;  ///< below Swapchain::kSlots: what this frame reads was last read by a frame that is done
};

/// The images of one window. Made anew when the window changes, also after it was lost.
class Swapchain {
public:
    static constexpr uint32_t kSlots = 2;  ///< frames on their way at a time
    using MakeSurface = std::function<VkSurfaceKHR(VkInstance)>;
    using Draw = std::function<void(VkCommandBuffer, const WindowImage&)>;

    /// The device was opened with a presentation. `make_surface` throws Error if it cannot.
    Swapchain(gpu::Device&, MakeSurface make_surface);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    bool offers(WindowCodes) const;

    /// Shows what `draw` draws: it begins and ends rendering into a colour attachment. False: nothing was shown, since
    /// the window has no size, is hidden or has just changed. Throws Error, also when the device is lost or codes are
    /// not offered.
    bool show(const SwapchainSettings&, const Draw& draw);

    /// Size, format and presentation mode of the images, in words.
    std::string describe() const;

private:
    struct Slot {
        gpu::CommandBuffer commands;
        gpu::OwnedFence done;
        gpu::Owned<VkSemaphore, vkDestroySemaphore> acquired;
    };
    struct Image {
        VkImage image;
        gpu::Owned<VkImageView, vkDestroyImageView> view;
        gpu::Owned<VkSemaphore, vkDestroySemaphore> drawn;
    };

    void open_surface();
    void close_surface() noexcept;
    bool rebuild(const SwapchainSettings&);
    void describe_light(const SwapchainSettings&) const;
    void record(const Slot&, const Image&, const Draw&, uint32_t slot) const;
    VkResult present(const Slot&, uint32_t image);

    gpu::Device& device_;
    MakeSurface make_surface_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    std::vector<VkSurfaceFormatKHR> formats_;
    std::vector<VkPresentModeKHR> modes_;
    gpu::Owned<VkSwapchainKHR, vkDestroySwapchainKHR> swapchain_;
    std::vector<Image> images_;
    std::array<Slot, kSlots> slots_;
    uint32_t next_slot_ = 0;
    SwapchainSettings built_for_;
    VkExtent2D extent_{};
    VkSurfaceFormatKHR format_{};
    VkPresentModeKHR mode_ = VK_PRESENT_MODE_FIFO_KHR;
    bool stale_ = true;
};

}  // namespace vesper::window
