#include "window/input_devices.h"

#include <algorithm>
#include <cmath>

namespace vesper::drive {
namespace {

// A key is all or nothing: from straight on to the full lock takes 0.7 s at rest. At speed less lock is of use: 0.15 of
// it at 30 m/s, 4.5 m/s^2 of lateral acceleration for a wheel of 0.6 rad at the road.
constexpr double kTurn = 1.4, kReturn = 3;  // locks per s
constexpr double kHalfLockSpeed = 5.3;      // m/s

double lock_at(double speed) { return 1 / (1 + std::abs(speed) / kHalfLockSpeed); }

double towards(double from, double to, double most) { return from + std::clamp(to - from, -most, most); }

const std::vector<float>& axes_of(const ControllerState& c, const ControllerMapping& m) {
    return m.gamepad ? c.pad_axes : c.axes;
}
const std::vector<bool>& buttons_of(const ControllerState& c, const ControllerMapping& m) {
    return m.gamepad ? c.pad_buttons : c.buttons;
}

}  // namespace

double KeyboardWheel::turn(const HeldInput& held, double speed, double seconds) {
    const double target = (held.left ? 1 : 0) - (held.right ? 1 : 0);
    const double lock = lock_at(speed);
    const bool back = target == 0 || target * angle_ < 0;
    angle_ = std::clamp(towards(angle_, target * lock, (back ? kReturn : kTurn) * lock * seconds), -1.0, 1.0);
    return angle_;
}

std::vector<Action> InputDevices::look(std::vector<ControllerState> now) {
    std::vector<Action> actions;
    for (const ControllerState& c : now) {
        const auto before = std::find_if(controllers_.begin(), controllers_.end(),
                                         [&](const ControllerState& o) { return o.name == c.name; });
        const ControllerMapping* mapping = mapping_of(c);
        if (before == controllers_.end()) {
            notice_ = c.name + (mapping ? " is ready" : " has no mapping: see docs/simulator.md, --controllers");
        } else if (mapping) {
            const auto &is = buttons_of(c, *mapping), &was = buttons_of(*before, *mapping);
            for (const auto& [button, action] : mapping->buttons)
                if (button < is.size() && is[button] && !(button < was.size() && was[button]))
                    actions.push_back(action);
        }
    }
    for (const ControllerState& c : controllers_)
        if (std::none_of(now.begin(), now.end(), [&](const ControllerState& o) { return o.name == c.name; }))
            notice_ = c.name + " was unplugged";
    controllers_ = std::move(now);
    return actions;
}

bool InputDevices::press(Action action) {
    const auto indicate = [&](traffic::Indicator side) {
        input_.indicator = input_.indicator == side ? traffic::Indicator::None : side;
    };
    switch (action) {
        case Action::Autopilot:
            input_.autopilot = !input_.autopilot;
            return true;
        case Action::Reverse:
            input_.reverse = !input_.reverse;
            return true;
        case Action::Beam:
            input_.beam = input_.beam == traffic::Beam::Low    ? traffic::Beam::High
                          : input_.beam == traffic::Beam::High ? traffic::Beam::Off
                                                               : traffic::Beam::Low;
            return true;
        case Action::IndicateLeft:
            indicate(traffic::Indicator::Left);
            return true;
        case Action::IndicateRight:
            indicate(traffic::Indicator::Right);
            return true;
        case Action::Hazard:
            indicate(traffic::Indicator::Both);
            return true;
        default:
            return false;
    }
}

traffic::DriverInput InputDevices::next(const HeldInput& held, double speed, double seconds) {
    input_.steering = wheel_.turn(held, speed, seconds);
    input_.throttle = held.accelerate ? 1 : 0;
    input_.brake = held.brake ? 1 : 0;
    for (const ControllerState& c : controllers_) {
        const ControllerMapping* mapping = mapping_of(c);
        if (!mapping) continue;
        const auto& axes = axes_of(c, *mapping);
        if (mapping->steering)
            if (const double turned = mapping->steering->value(axes); std::abs(turned) > std::abs(input_.steering))
                input_.steering = turned;
        if (mapping->throttle) input_.throttle = std::max(input_.throttle, mapping->throttle->value(axes));
        if (mapping->brake) input_.brake = std::max(input_.brake, mapping->brake->value(axes));
    }
    return input_;
}

}  // namespace vesper::drive
