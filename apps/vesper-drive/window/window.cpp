#include "window/window.h"

#include <algorithm>

#define GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

namespace vesper::drive {
namespace {

std::string last_glfw_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? std::string(": ") + text : "";
}

std::vector<GLFWmonitor*> all_monitors() {
    int count = 0;
    GLFWmonitor** monitors = glfwGetMonitors(&count);
    return {monitors, monitors + count};
}

// For as long as there is a window.
struct Glfw {
    Glfw() {
        if (!glfwInit()) throw Error("no window can be opened" + last_glfw_error() + " (--headless needs no display)");
    }
    ~Glfw() { glfwTerminate(); }
};

}  // namespace

Window::Window(const WindowSettings& settings)
    : width_(int(settings.extent.width)), height_(int(settings.extent.height)), title_(settings.title) {
    static const Glfw glfw;
    if (!glfwVulkanSupported())
        throw Error(
            "no window can show what Vulkan draws: install a driver (Debian, Ubuntu: apt install mesa-vulkan-drivers)");
    if (settings.monitor && *settings.monitor >= all_monitors().size())
        throw Error("--fullscreen " + std::to_string(*settings.monitor) + ": there are " +
                    std::to_string(all_monitors().size()) + " monitors, counted from 0");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);  // full screen stays beside other screens' windows
    window_ = glfwCreateWindow(width_, height_, title_.c_str(), nullptr, nullptr);
    if (!window_) throw Error("no window can be opened" + last_glfw_error());
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int modifiers) {
        const auto* self = static_cast<const Window*>(glfwGetWindowUserPointer(window));
        if (action == GLFW_PRESS && self->on_key) self->on_key(key, modifiers);
    });
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** files) {
        const auto* self = static_cast<const Window*>(glfwGetWindowUserPointer(window));
        if (count > 0 && self->on_drop) self->on_drop(files[0]);
    });
    if (settings.monitor) fill(settings.monitor);
}

Window::~Window() { glfwDestroyWindow(window_); }

gpu::Presentation Window::presentation() const {
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    return {.instance_extensions = {names, names + count},
            .possible = [](VkInstance instance, VkPhysicalDevice device, uint32_t family) {
                return glfwGetPhysicalDevicePresentationSupport(instance, device, family) == GLFW_TRUE;
            }};
}

VkSurfaceKHR Window::make_surface(VkInstance instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (glfwCreateWindowSurface(instance, window_, nullptr, &surface) != VK_SUCCESS)
        throw Error("the window cannot be drawn into" + last_glfw_error());
    return surface;
}

VkExtent2D Window::extent() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {uint32_t(width), uint32_t(height)};
}

bool Window::is_minimised() const {
    return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) || extent().width == 0 || extent().height == 0;
}
bool Window::is_closing() const { return glfwWindowShouldClose(window_); }
void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
bool Window::is_pressed(int key) const { return glfwGetKey(window_, key) == GLFW_PRESS; }
bool Window::is_button_pressed(int button) const { return glfwGetMouseButton(window_, button) == GLFW_PRESS; }

void Window::set_title(const std::string& title) {
    if (title == title_) return;
    title_ = title;
    glfwSetWindowTitle(window_, title.c_str());
}

glm::dvec2 Window::mouse() const {
    glm::dvec2 at;
    glfwGetCursorPos(window_, &at.x, &at.y);
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    const VkExtent2D px = extent();
    return at * glm::dvec2(px.width, px.height) / glm::dvec2(std::max(width, 1), std::max(height, 1));
}

void Window::poll(double patience) {
    if (patience > 0)
        glfwWaitEventsTimeout(patience);
    else
        glfwPollEvents();
}

std::vector<std::string> Window::monitors() {
    std::vector<std::string> names;
    for (GLFWmonitor* monitor : all_monitors()) {
        const GLFWvidmode* mode = glfwGetVideoMode(monitor);
        names.push_back(std::string(glfwGetMonitorName(monitor)) +
                        (mode ? ", " + std::to_string(mode->width) + "x" + std::to_string(mode->height) + ", " +
                                    std::to_string(mode->refreshRate) + " Hz"
                              : ""));
    }
    return names;
}

std::optional<unsigned> Window::monitor() const {
    const auto all = all_monitors();
    const auto found = std::find(all.begin(), all.end(), glfwGetWindowMonitor(window_));
    if (found == all.end()) return std::nullopt;
    return unsigned(found - all.begin());
}

void Window::fill(std::optional<unsigned> monitor) {
    const auto all = all_monitors();
    if (!glfwGetWindowMonitor(window_)) {
        glfwGetWindowPos(window_, &x_, &y_);
        glfwGetWindowSize(window_, &width_, &height_);
    }
    const GLFWvidmode* mode = monitor && *monitor < all.size() ? glfwGetVideoMode(all[*monitor]) : nullptr;
    if (mode)  // the mode the desktop has: nothing flickers, and refresh rates stay
        glfwSetWindowMonitor(window_, all[*monitor], 0, 0, mode->width, mode->height, mode->refreshRate);
    else if (!monitor)
        glfwSetWindowMonitor(window_, nullptr, x_, y_, width_, height_, GLFW_DONT_CARE);
}

unsigned Window::nearest_monitor() const {
    int x = 0, y = 0, width = 0, height = 0;
    glfwGetWindowPos(window_, &x, &y);
    glfwGetWindowSize(window_, &width, &height);
    const auto all = all_monitors();
    unsigned best = 0;
    int most = -1;
    for (unsigned i = 0; i < all.size(); ++i) {
        const GLFWvidmode* mode = glfwGetVideoMode(all[i]);
        int left = 0, top = 0;
        glfwGetMonitorPos(all[i], &left, &top);
        if (!mode) continue;
        const int covered = std::max(0, std::min(x + width, left + mode->width) - std::max(x, left)) *
                            std::max(0, std::min(y + height, top + mode->height) - std::max(y, top));
        if (covered > most) most = covered, best = i;
    }
    return best;
}

}  // namespace vesper::drive
