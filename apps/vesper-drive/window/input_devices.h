// Keys, gamepads and wheels, combined into the input of the driver. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "traffic/driver.h"
#include "window/controllers.h"

namespace vesper::drive {

/// Keys that are held.
struct HeldInput {
    bool left = false, right = false, accelerate = false, brake = false;
};

/// A wheel that keys turn: towards the side that is held, back to the middle otherwise, more slowly the faster the car
/// is.
class KeyboardWheel {
public:
    /// -1 (right) .. 1 (left) after `seconds`. `speed`: m/s.
    double turn(const HeldInput&, double speed, double seconds);

private:
    double angle_ = 0;
};

/// Everything that drives. What keys and controllers say is combined: the wheel that is turned further, the pedal that
/// is pressed harder.
class InputDevices {
public:
    explicit InputDevices(std::vector<ControllerMapping> mappings = {}) : mappings_(std::move(mappings)) {}

    /// Looks at what is plugged in now. Gives actions of buttons that went down since; what was just plugged in or out
    /// is said.
    std::vector<Action> look(std::vector<ControllerState>);
    /// Beam, indicators, autopilot, gear. False: the action is none of the driver's.
    bool press(Action);
    /// The input of the next step.
    traffic::DriverInput next(const HeldInput&, double speed, double seconds);

    const traffic::DriverInput& last() const { return input_; }
    void release() { input_ = {}, wheel_ = {}; }  ///< as at the start
    const std::vector<ControllerState>& controllers() const { return controllers_; }
    /// What a controller is used as; nothing: it has no mapping.
    const ControllerMapping* mapping_of(const ControllerState& c) const {
        return find_mapping(mappings_, c.name, c.is_gamepad());
    }
    std::string take_notice() { return std::exchange(notice_, {}); }  ///< what to tell the driver

private:
    std::vector<ControllerMapping> mappings_;
    std::vector<ControllerState> controllers_;
    KeyboardWheel wheel_;
    traffic::DriverInput input_;
    std::string notice_;
};

}  // namespace vesper::drive
