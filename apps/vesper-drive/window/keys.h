// What keys and buttons do. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace vesper::drive {

/// What happens at the press of a key or button. Steering and pedals are held instead: see input_devices.h.
enum class Action : uint8_t {
    Pause,
    Step,
    Restart,
    Autopilot,
    Reverse,
    Beam,
    IndicateLeft,
    IndicateRight,
    Hazard,
    NextCamera,
    CameraDriver,
    CameraChase,
    CameraBird,
    CameraFree,
    NextOperator,
    PreviousOperator,
    NextGlare,
    NextDisplay,
    OlderObserver,
    YoungerObserver,
    SunUp,
    SunDown,
    Shadows,
    HatchUnseen,
    Keys,
    Clean,
    Performance,
    Light,
    Eye,
    Switches,
    Lamps,
    Probe,
    Obstacles,
    FalseColour,
    Controllers,
    Focus,
    RecordDrive,
    SavePicture,
    Reload,
    FullScreen,
    NextMonitor,
    NextVsync,
    NextScaling,
    FinerPicture,
    CoarserPicture,
    FasterQuality,
    TruerQuality,
    Leave,
    Quit,
};

struct KeyBinding {
    Action action;
    int key, modifiers;     ///< GLFW; modifiers: shift and control
    const char* shown;      ///< on the keyboard
    std::string_view name;  ///< in mapping files
    const char* does;
    const char* group;
};
/// One for every action, in the order of the help.
std::span<const KeyBinding> key_bindings();
std::optional<Action> action_of(int key, int modifiers);
std::optional<Action> action_named(std::string_view name);

/// Keys that are held, for the help.
struct HeldKeys {
    const char* shown;
    const char* does;
};
std::span<const HeldKeys> held_keys();

}  // namespace vesper::drive
