// Gamepads, steering wheels and pedals: which axis and button is what. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "window/keys.h"

namespace vesper::drive {

/// One axis as something from `rest` (nothing) to `full` (all of it); both between -1 and 1.
struct PedalAxis {
    size_t axis = 0;
    double rest = -1, full = 1;
    double value(std::span<const float> axes) const;  ///< 0 .. 1; 0 where there is no such axis
};

/// One axis from full left to full right.
struct SteeringAxis {
    size_t axis = 0;
    double left = -1, right = 1;
    double dead = 0;                                  ///< part of either half that is straight on, [0, 1)
    double exponent = 1;                              ///< of what is left: above 1 it is finer about the middle
    double value(std::span<const float> axes) const;  ///< -1 (right) .. 1 (left)
};

/// What the axes and buttons of a device mean.
struct ControllerMapping {
    std::string match;     ///< part of the name of the device, any case; empty: everything
    bool gamepad = false;  ///< axes and buttons are those of GLFW's standard gamepad
    std::optional<SteeringAxis> steering;
    std::optional<PedalAxis> throttle, brake;
    std::map<size_t, Action> buttons;
};

/// Standard gamepads: left stick, triggers, buttons.
const ControllerMapping& gamepad_mapping();
/// Reads a file of mappings (docs/controllers.md). Throws Error with file, place and reason.
std::vector<ControllerMapping> read_controllers(const std::filesystem::path&);
/// The first that fits a device; nothing if none does.
const ControllerMapping* find_mapping(std::span<const ControllerMapping>, const std::string& device, bool is_gamepad);

/// What is plugged in at the moment, as GLFW sees it.
struct ControllerState {
    std::string name;
    std::vector<float> axes;
    std::vector<bool> buttons;
    std::vector<float> pad_axes;  ///< as of a standard gamepad; empty: it is none
    std::vector<bool> pad_buttons;
    bool is_gamepad() const { return !pad_axes.empty(); }
};
std::vector<ControllerState> plugged_in();

}  // namespace vesper::drive
