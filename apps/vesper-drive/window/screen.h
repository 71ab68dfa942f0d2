// What a window shows: a picture, and instruments over it. SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "vision/display.h"
#include "window/presenter.h"
#include "window/window.h"

namespace vesper::drive {

struct ScreenSettings {
    window::Vsync vsync = window::Vsync::Wait;
    window::Scaling scaling = window::Scaling::Fit;
};

/// Of --vsync.
window::Vsync vsync_of(const std::string& name);

/// Shows pictures in a window, with Dear ImGui over them. One at a time.
class Screen {
public:
    Screen(Window&, gpu::Device&);
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    /// Whether the window can show the codes of such a display.
    bool shows(const vision::Display&) const;

    /// Between these two, instruments are declared (ImGui::Begin and the like). Keys are theirs while `keyboard` says
    /// so, but for those of letters typed.
    void begin_instruments(bool keyboard);
    /// Where the next frame of a display's codes is shown; then picture() is that frame.
    graph::ExternalImage image_for(VkExtent2D extent, uint32_t bits) { return image_.target(extent, bits); }
    window::Picture picture() const { return image_.picture(); }
    /// Shows a picture of a display and the instruments. False: nothing was shown, for now.
    bool show(const window::Picture&, const vision::Display&, const ScreenSettings&);

    /// The px of a picture of this size that is under the mouse; nothing beside it, or over an instrument.
    std::optional<glm::uvec2> pixel_under_mouse(VkExtent2D picture, window::Scaling) const;
    bool is_typing() const;  ///< letters go into a field of an instrument
    std::string describe() const { return swapchain_.describe(); }

private:
    struct Instruments;  // Dear ImGui
    Window& window_;
    std::unique_ptr<Instruments> instruments_;
    window::Swapchain swapchain_;
    window::PictureImage image_;
    window::Presenter presenter_;  // waits for what was drawn, which uses the image
};

}  // namespace vesper::drive
