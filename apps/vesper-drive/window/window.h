// The window on the desktop: its size, its monitor, what is pressed in it. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/device.h"

struct GLFWwindow;

namespace vesper::drive {

struct WindowSettings {
    std::string title = "Vesper";
    VkExtent2D extent{1280, 800};     ///< px, when not full screen
    std::optional<unsigned> monitor;  ///< full screen on this one, counted from 0
};

/// One window of GLFW, under X11 or Wayland, as the library at hand has it. One at a time.
class Window {
public:
    /// Throws Error where there is no display, or no such monitor.
    explicit Window(const WindowSettings&);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    GLFWwindow* handle() const { return window_; }
    /// For the device that is to show pictures in the window.
    gpu::Presentation presentation() const;
    VkSurfaceKHR make_surface(VkInstance) const;

    VkExtent2D extent() const;  ///< px; nothing while minimised
    bool is_minimised() const;
    bool is_closing() const;
    void close();
    void set_title(const std::string&);
    glm::dvec2 mouse() const;        ///< px from the upper left corner
    bool is_pressed(int key) const;  ///< a GLFW key
    bool is_button_pressed(int button) const;

    /// Takes the events that came, or waits so long for one, s.
    void poll(double patience = 0);
    /// Called for a key that goes down: GLFW key and modifiers. Repeats are none.
    std::function<void(int key, int modifiers)> on_key;
    /// Called for a file that is dropped into the window.
    std::function<void(const std::string& file)> on_drop;

    static std::vector<std::string> monitors();  ///< names and sizes
    std::optional<unsigned> monitor() const;     ///< the one that is filled
    /// Fills a monitor, or, with nothing, becomes a window again where it was.
    void fill(std::optional<unsigned> monitor);
    unsigned nearest_monitor() const;  ///< that shows most of the window

private:
    GLFWwindow* window_ = nullptr;
    int x_ = 80, y_ = 80, width_ = 0, height_ = 0;  // when not full screen, screen coordinates
    std::string title_;
};

}  // namespace vesper::drive
