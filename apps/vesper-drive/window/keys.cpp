#include "window/keys.h"

#include <algorithm>
#include <array>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace vesper::drive {
namespace {

constexpr int kShift = GLFW_MOD_SHIFT, kControl = GLFW_MOD_CONTROL;

constexpr std::array kBindings{
    KeyBinding{Action::Pause, GLFW_KEY_SPACE, 0, "Space", "pause", "Pause", "Drive"},
    KeyBinding{Action::Step, GLFW_KEY_PERIOD, 0, ".", "step", "One step, while paused", "Drive"},
    KeyBinding{Action::Restart, GLFW_KEY_BACKSPACE, 0, "Backspace", "restart", "Start again", "Drive"},
    KeyBinding{Action::Autopilot, GLFW_KEY_K, 0, "K", "autopilot", "Autopilot", "Drive"},
    KeyBinding{Action::Reverse, GLFW_KEY_R, 0, "R", "reverse", "Forwards or backwards", "Drive"},
    KeyBinding{Action::Beam, GLFW_KEY_L, 0, "L", "beam", "Low beam, high beam, no lights", "Drive"},
    KeyBinding{Action::IndicateLeft, GLFW_KEY_Q, 0, "Q", "indicate-left", "Turn signal left", "Drive"},
    KeyBinding{Action::IndicateRight, GLFW_KEY_E, 0, "E", "indicate-right", "Turn signal right", "Drive"},
    KeyBinding{Action::Hazard, GLFW_KEY_H, 0, "H", "hazard", "Hazard lights", "Drive"},
    KeyBinding{Action::RecordDrive, GLFW_KEY_F9, 0, "F9", "record", "Record to a file, or stop", "Drive"},

    KeyBinding{Action::NextCamera, GLFW_KEY_C, 0, "C", "next-camera", "Next camera", "Camera"},
    KeyBinding{Action::CameraDriver, GLFW_KEY_1, 0, "1", "camera-driver", "Driver", "Camera"},
    KeyBinding{Action::CameraChase, GLFW_KEY_2, 0, "2", "camera-chase", "Behind the car", "Camera"},
    KeyBinding{Action::CameraBird, GLFW_KEY_3, 0, "3", "camera-bird", "From above", "Camera"},
    KeyBinding{Action::CameraFree, GLFW_KEY_4, 0, "4", "camera-free",
               "Free: W A S D, Page Up and Down, with Shift to turn; or drag with the right mouse button", "Camera"},

    KeyBinding{Action::NextOperator, GLFW_KEY_O, 0, "O", "next-operator", "Next tone operator", "Light and eye"},
    KeyBinding{Action::PreviousOperator, GLFW_KEY_O, kShift, "Shift+O", "previous-operator", "Previous tone operator",
               "Light and eye"},
    KeyBinding{Action::NextGlare, GLFW_KEY_G, 0, "G", "next-glare", "Next kind of glare", "Light and eye"},
    KeyBinding{Action::NextDisplay, GLFW_KEY_Y, 0, "Y", "next-display", "Next display", "Light and eye"},
    KeyBinding{Action::OlderObserver, GLFW_KEY_V, 0, "V", "older-observer", "An observer five years older",
               "Light and eye"},
    KeyBinding{Action::YoungerObserver, GLFW_KEY_V, kShift, "Shift+V", "younger-observer", "and younger",
               "Light and eye"},
    KeyBinding{Action::SunUp, GLFW_KEY_RIGHT_BRACKET, 0, "]", "sun-up", "Sun half a degree higher", "Light and eye"},
    KeyBinding{Action::SunDown, GLFW_KEY_LEFT_BRACKET, 0, "[", "sun-down",
               "Sun half a degree lower; below -18 degrees: night", "Light and eye"},
    KeyBinding{Action::Shadows, GLFW_KEY_F10, 0, "F10", "shadows", "Shadows of lamps, or none", "Light and eye"},
    KeyBinding{Action::HatchUnseen, GLFW_KEY_U, 0, "U", "hatch-unseen", "Stripes over obstacles that are not seen",
               "Light and eye"},

    KeyBinding{Action::Keys, GLFW_KEY_F1, 0, "F1", "keys", "This list", "Instruments"},
    KeyBinding{Action::Clean, GLFW_KEY_F2, 0, "F2", "clean", "Nothing but the picture, or everything again",
               "Instruments"},
    KeyBinding{Action::Performance, GLFW_KEY_F3, 0, "F3", "performance", "Frames per second, milliseconds of passes",
               "Instruments"},
    KeyBinding{Action::Light, GLFW_KEY_F4, 0, "F4", "light", "Histogram, tone curve, adaptation, display range",
               "Instruments"},
    KeyBinding{Action::Eye, GLFW_KEY_F5, 0, "F5", "eye", "State of the eye over time", "Instruments"},
    KeyBinding{Action::Switches, GLFW_KEY_F6, 0, "F6", "switches", "Operator, glare, display, observer", "Instruments"},
    KeyBinding{Action::Lamps, GLFW_KEY_F7, 0, "F7", "lamps", "Lamps by group", "Instruments"},
    KeyBinding{Action::Probe, GLFW_KEY_F8, 0, "F8", "probe", "Luminance and illuminance under the mouse",
               "Instruments"},
    KeyBinding{Action::Obstacles, GLFW_KEY_I, 0, "I", "obstacles", "How visible the obstacles are (--obstacle)",
               "Instruments"},
    KeyBinding{Action::FalseColour, GLFW_KEY_F, 0, "F", "false-colour", "Luminance as colours", "Instruments"},
    KeyBinding{Action::Controllers, GLFW_KEY_J, 0, "J", "controllers", "Axes and buttons of what is plugged in",
               "Instruments"},
    KeyBinding{Action::Focus, GLFW_KEY_TAB, 0, "Tab", "focus",
               "Keyboard to the instruments and back: arrows move, Ctrl+Tab to the next one, Space presses, Enter "
               "types a number, Esc leaves",
               "Instruments"},

    KeyBinding{Action::SavePicture, GLFW_KEY_F12, 0, "F12", "picture", "Save the picture as a file", "Window"},
    KeyBinding{Action::Reload, GLFW_KEY_R, kControl, "Ctrl+R", "reload",
               "Read the scene again; another one can be dropped into the window", "Window"},
    KeyBinding{Action::FullScreen, GLFW_KEY_F11, 0, "F11", "full-screen", "Full screen", "Window"},
    KeyBinding{Action::NextMonitor, GLFW_KEY_F11, kShift, "Shift+F11", "next-monitor",
               "Full screen on the next monitor", "Window"},
    KeyBinding{Action::NextVsync, GLFW_KEY_M, 0, "M", "next-vsync",
               "Wait for the refresh, newest at the refresh, at once", "Window"},
    KeyBinding{Action::NextScaling, GLFW_KEY_X, 0, "X", "next-scaling", "Fill the window, or repeat whole pixels",
               "Window"},
    KeyBinding{Action::FinerPicture, GLFW_KEY_EQUAL, 0, "=", "finer-picture", "More pixels are rendered", "Window"},
    KeyBinding{Action::CoarserPicture, GLFW_KEY_MINUS, 0, "-", "coarser-picture", "Fewer pixels are rendered",
               "Window"},
    KeyBinding{Action::FasterQuality, GLFW_KEY_T, 0, "T", "faster-quality", "The next faster quality", "Window"},
    KeyBinding{Action::TruerQuality, GLFW_KEY_T, kShift, "Shift+T", "truer-quality", "and the next truer one",
               "Window"},
    KeyBinding{Action::Leave, GLFW_KEY_ESCAPE, 0, "Esc", "leave", "Close the instruments; where none is open, end",
               "Window"},
    KeyBinding{Action::Quit, GLFW_KEY_Q, kControl, "Ctrl+Q", "quit", "End", "Window"},
};

constexpr std::array kHeld{
    HeldKeys{"Left, Right or A, D", "Steer"},
    HeldKeys{"Up or W", "Accelerate"},
    HeldKeys{"Down or S", "Brake"},
};

}  // namespace

std::span<const KeyBinding> key_bindings() { return kBindings; }
std::span<const HeldKeys> held_keys() { return kHeld; }

std::optional<Action> action_of(int key, int modifiers) {
    const auto found = std::find_if(kBindings.begin(), kBindings.end(), [&](const KeyBinding& b) {
        return b.key == key && b.modifiers == (modifiers & (kShift | kControl));
    });
    if (found == kBindings.end()) return std::nullopt;
    return found->action;
}

std::optional<Action> action_named(std::string_view name) {
    const auto found =
        std::find_if(kBindings.begin(), kBindings.end(), [&](const KeyBinding& b) { return b.name == name; });
    if (found == kBindings.end()) return std::nullopt;
    return found->action;
}

}  // namespace vesper::drive
