#include "window/controllers.h"

#include <algorithm>
#include <cmath>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "base/lower.h"
#include "io/read_file.h"
#include "scene/json_value.h"

namespace vesper::drive {
namespace {

constexpr size_t kMostAxes = 64, kMostButtons = 256, kMostMappings = 256;
constexpr uint64_t kMaxControllerBytes = 1 << 20;

/// The member that is an end of an axis.
double end_of(const scene::JsonValue& value, const char* key, double fallback) {
    return value.number_or(key, fallback, -1, 1);
}

PedalAxis read_pedal(const scene::JsonValue& value) {
    value.allow_only({"axis", "rest", "full"});
    const PedalAxis pedal{size_t(value.at("axis").integer(kMostAxes - 1)), end_of(value, "rest", -1),
                          end_of(value, "full", 1)};
    if (std::abs(pedal.full - pedal.rest) < 0.01) value.fail("rest and full must differ");
    return pedal;
}

SteeringAxis read_steering(const scene::JsonValue& value) {
    value.allow_only({"axis", "left", "right", "dead", "exponent"});
    const SteeringAxis steering{size_t(value.at("axis").integer(kMostAxes - 1)), end_of(value, "left", -1),
                                end_of(value, "right", 1), value.number_or("dead", 0, 0, 0.9),
                                value.number_or("exponent", 1, 0.2, 5)};
    if (std::abs(steering.left - steering.right) < 0.01) value.fail("left and right must differ");
    return steering;
}

ControllerMapping read_mapping(const scene::JsonValue& value) {
    value.allow_only({"match", "gamepad", "steering", "throttle", "brake", "buttons"});
    ControllerMapping mapping{.match = value.at("match").text(),
                              .gamepad = value.boolean_or("gamepad", false),
                              .steering = {},
                              .throttle = {},
                              .brake = {},
                              .buttons = {}};
    if (const auto steering = value.find("steering")) mapping.steering = read_steering(*steering);
    if (const auto throttle = value.find("throttle")) mapping.throttle = read_pedal(*throttle);
    if (const auto brake = value.find("brake")) mapping.brake = read_pedal(*brake);
    for (const scene::JsonValue& button : value.elements_of("buttons")) {
        button.allow_only({"button", "does"});
        const auto number = size_t(button.at("button").integer(kMostButtons - 1));
        const auto action = action_named(button.at("does").text());
        if (!action) {
            std::string names;
            for (const KeyBinding& known : key_bindings())
                names += (names.empty() ? "" : ", ") + std::string(known.name);
            button.at("does").fail("no such action; there are " + names);
        }
        if (!mapping.buttons.emplace(number, *action).second)
            button.at("button").fail("this button already does something");
    }
    return mapping;
}

}  // namespace

double PedalAxis::value(std::span<const float> axes) const {
    if (axis >= axes.size() || !std::isfinite(axes[axis])) return 0;
    return std::clamp((double(axes[axis]) - rest) / (full - rest), 0.0, 1.0);
}

double SteeringAxis::value(std::span<const float> axes) const {
    if (axis >= axes.size() || !std::isfinite(axes[axis])) return 0;
    const double turned = std::clamp(2 * (double(axes[axis]) - right) / (left - right) - 1, -1.0, 1.0);
    const double beyond = std::max(std::abs(turned) - dead, 0.0) / (1 - dead);
    return std::copysign(std::pow(beyond, exponent), turned);
}

const ControllerMapping& gamepad_mapping() {
    static const ControllerMapping mapping{
        .match = "",
        .gamepad = true,
        .steering = SteeringAxis{.axis = GLFW_GAMEPAD_AXIS_LEFT_X, .dead = 0.1, .exponent = 1.5},
        .throttle = PedalAxis{.axis = GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER},
        .brake = PedalAxis{.axis = GLFW_GAMEPAD_AXIS_LEFT_TRIGGER},
        .buttons = {{GLFW_GAMEPAD_BUTTON_START, Action::Pause},
                    {GLFW_GAMEPAD_BUTTON_BACK, Action::Restart},
                    {GLFW_GAMEPAD_BUTTON_A, Action::Autopilot},
                    {GLFW_GAMEPAD_BUTTON_B, Action::Reverse},
                    {GLFW_GAMEPAD_BUTTON_X, Action::Beam},
                    {GLFW_GAMEPAD_BUTTON_Y, Action::NextCamera},
                    {GLFW_GAMEPAD_BUTTON_LEFT_BUMPER, Action::IndicateLeft},
                    {GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER, Action::IndicateRight},
                    {GLFW_GAMEPAD_BUTTON_DPAD_UP, Action::NextOperator},
                    {GLFW_GAMEPAD_BUTTON_DPAD_DOWN, Action::NextGlare},
                    {GLFW_GAMEPAD_BUTTON_DPAD_LEFT, Action::Clean},
                    {GLFW_GAMEPAD_BUTTON_DPAD_RIGHT, Action::FalseColour}}};
    return mapping;
}

std::vector<ControllerMapping> read_controllers(const std::filesystem::path& file) {
    const scene::JsonFile json = scene::parse_json(io::read_file(file, kMaxControllerBytes), file.string());
    const scene::JsonValue root(json);
    root.allow_only({"controllers"});
    std::vector<ControllerMapping> mappings;
    const auto elements = root.at("controllers").elements();
    if (elements.size() > kMostMappings) root.at("controllers").fail("more than " + std::to_string(kMostMappings));
    for (const scene::JsonValue& element : elements) mappings.push_back(read_mapping(element));
    return mappings;
}

const ControllerMapping* find_mapping(std::span<const ControllerMapping> mappings, const std::string& device,
                                      bool is_gamepad) {
    const std::string name = lower(device);
    for (const ControllerMapping& mapping : mappings)
        if (name.find(lower(mapping.match)) != name.npos && (!mapping.gamepad || is_gamepad)) return &mapping;
    return is_gamepad ? &gamepad_mapping() : nullptr;
}

std::vector<ControllerState> plugged_in() {
    std::vector<ControllerState> all;
    for (int id = GLFW_JOYSTICK_1; id <= GLFW_JOYSTICK_LAST; ++id) {
        if (!glfwJoystickPresent(id)) continue;
        int axes = 0, buttons = 0;
        const float* values = glfwGetJoystickAxes(id, &axes);
        const unsigned char* pressed = glfwGetJoystickButtons(id, &buttons);
        const char* name = glfwGetJoystickName(id);
        GLFWgamepadstate pad;
        ControllerState state;
        state.name = name ? name : "";
        state.axes.assign(values, values + axes);
        state.buttons.assign(pressed, pressed + buttons);
        if (glfwGetGamepadState(id, &pad)) {
            state.pad_axes.assign(pad.axes, pad.axes + GLFW_GAMEPAD_AXIS_LAST + 1);
            state.pad_buttons.assign(pad.buttons, pad.buttons + GLFW_GAMEPAD_BUTTON_LAST + 1);
        }
        all.push_back(std::move(state));
    }
    return all;
}

}  // namespace vesper::drive
