// What actions of a storyboard set: lamps, traffic lights, the time of day, parameters. SPDX-License-Identifier: MIT
#include "roads/storyboard_actions.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "photometry/table.h"

namespace vesper::roads {
namespace {

/// Actions that neither lamps, lights nor motion follow from, done at once.
bool is_without_effect(std::string_view name) {
    constexpr std::array kNames{"VisibilityAction",
                                "ControllerAction",
                                "ActivateControllerAction",
                                "AssignControllerAction",
                                "OverrideControllerValueAction",
                                "AssignRouteAction",
                                "AcquirePositionAction",
                                "RandomRouteAction",
                                "TrailerAction",
                                "AnimationAction",
                                "EntityAction",
                                "TrafficAction",
                                "SetMonitorAction",
                                "CustomCommandAction"};
    return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

struct ActionReader {
    const Parameters& scope;
    StoryTime& story;
    std::vector<StoryAction> made{};

    void leave_out(const XmlElement& element, const std::string& why) {
        story.note(element.place() + ": " + why + ": left out");
    }

    void lamp(const XmlElement& element) {
        const auto type = element.child("LightType"), state = element.child("LightState");
        const auto vehicle = type ? type->child("VehicleLight") : std::nullopt;
        if (!vehicle || !state) return leave_out(element, "no vehicle light");
        const std::string name = resolved(*vehicle, "vehicleLightType", scope).value_or("");
        static const std::map<std::string, std::vector<RunLamp>> kLamps{
            {"lowBeam", {RunLamp::LowBeam}},
            {"highBeam", {RunLamp::HighBeam}},
            {"daytimeRunningLights", {RunLamp::DaytimeRunning}},
            {"fogLights", {RunLamp::FogFront, RunLamp::FogRear}},
            {"fogLightsFront", {RunLamp::FogFront}},
            {"fogLightsRear", {RunLamp::FogRear}},
            {"brakeLights", {RunLamp::Brake}},
            {"reversingLights", {RunLamp::Reversing}},
            {"indicatorLeft", {RunLamp::IndicatorLeft}},
            {"indicatorRight", {RunLamp::IndicatorRight}},
            {"warningLights", {RunLamp::IndicatorLeft, RunLamp::IndicatorRight}},
            {"licensePlateIllumination", {RunLamp::LicencePlate}},
            {"specialPurposeLights", {RunLamp::SpecialPurpose}}};
        static const std::map<std::string, LampEvent::Mode> kModes{
            {"on", LampEvent::Mode::On}, {"off", LampEvent::Mode::Off}, {"flashing", LampEvent::Mode::Flashing}};
        const auto lamps = kLamps.find(name);
        if (lamps == kLamps.end()) return leave_out(*vehicle, "there is no light '" + name + "'");
        const std::string mode = resolved(*state, "mode", scope).value_or("on");
        const auto known = kModes.find(mode);
        if (known == kModes.end()) return leave_out(*state, "mode '" + mode + "' is none of OpenSCENARIO's");
        LampEvent event{.mode = known->second};
        event.transition = std::clamp(number_in(element, "transitionTime", scope, 0), 0.0, 3600.0);
        event.on_time = std::clamp(number_in(*state, "flashingOnDuration", scope, 0.5), 0.0, 3600.0);
        event.off_time = std::clamp(number_in(*state, "flashingOffDuration", scope, 0.5), 0.0, 3600.0);
        event.intensity = std::max(0.0, number_in(*state, "luminousIntensity", scope, 0));
        if (const auto colour = state->child("Color"))
            if (const auto rgb = colour->child("ColorRgb"))
                event.colour = glm::dvec3{number_in(*rgb, "red", scope, 0), number_in(*rgb, "green", scope, 0),
                                          number_in(*rgb, "blue", scope, 0)};
        StoryAction action;
        for (const RunLamp lamp : lamps->second) action.domains |= 1u << static_cast<uint32_t>(lamp);
        action.each = [event, &set = lamps->second, &s = story](RunEntity& actor, int step) -> Progress {
            LampEvent now = event;
            now.time = s.at(step);
            for (const RunLamp lamp : set) {
                s.keep();
                actor.lamps[static_cast<size_t>(lamp)].push_back(now);
                actor.stated[static_cast<size_t>(lamp)] = true;
            }
            // As esmini: what flashes does so until the lamp is set again.
            if (now.mode == LampEvent::Mode::Flashing) return [](int) { return false; };
            if (now.transition <= 0) return {};
            return [end = now.time + now.transition, &s](int later) { return s.at(later) >= end - 1e-6; };
        };
        made.push_back(std::move(action));
    }

    void once(std::function<void(int)> what) { made.push_back({std::move(what)}); }

    void signals(const XmlElement& infrastructure) {
        for (const XmlElement& action : infrastructure.children("TrafficSignalAction"))
            for (const XmlElement& each : action.children()) {
                if (each.name() != "TrafficSignalStateAction") {
                    leave_out(each, "controllers of traffic signals are not played");
                    continue;
                }
                const std::string name = resolved(each, "name", scope).value_or(""),
                                  state = resolved(each, "state", scope).value_or("");
                once([name, state, place = each.place(), &s = story](int step) {
                    s.keep();
                    s.run.signals.push_back({s.at(step), name, state, place});
                    s.signals[name] = state;
                });
            }
    }

    void environment(const XmlElement& action) {
        const auto inside = action.child("Environment"), reference = action.child("CatalogReference");
        const auto entry = !inside && reference ? story.scenario.find(*reference, scope) : std::nullopt;
        if (!inside && !entry) return leave_out(action, "no catalog has this environment");
        const XmlElement& found = inside ? *inside : entry->element;
        const Parameters inner = declared(found, inside ? scope : entry->parameters);
        for (const XmlElement& each : found.children()) {
            if (each.name() == "ParameterDeclarations" || each.name() == "Properties") continue;
            leave_out(each, "the sky and the weather are those of the scene");
            if (each.name() == "TimeOfDay")
                once([when = resolved(each, "dateTime", inner).value_or(""), &s = story](int step) {
                    s.keep();
                    s.run.time_of_day.push_back({s.at(step), "", when});
                });
        }
    }

    /// ParameterAction, VariableAction.
    void setting(const XmlElement& action) {
        const bool variable = action.name() == "VariableAction";
        std::string name = action.text_or(variable ? "variableRef" : "parameterRef", "");
        if (name.starts_with('$')) name.erase(0, 1);
        const auto around = scope.find(name);
        if (variable ? !story.variables.contains(name) : around == scope.end())
            return leave_out(action,
                             "there is no " + std::string(variable ? "variable" : "parameter") + " '" + name + "'");
        Parameters& values = variable ? story.variables : story.parameters;
        if (const auto set = action.child("SetAction"))
            return once([&values, name, value = resolved(*set, "value", scope).value_or("")](int) {
                values.insert_or_assign(name, value);
            });
        const auto modify = action.child("ModifyAction"), rule = modify ? modify->child("Rule") : std::nullopt;
        const auto add = rule ? rule->child("AddValue") : std::nullopt,
                   times = rule ? rule->child("MultiplyByValue") : std::nullopt;
        if (!add && !times) return leave_out(action, "it sets nothing");
        const double by = number_in(add ? *add : *times, "value", scope, 0);
        once([&values, name, by, adds = add.has_value(), before = variable ? "0" : around->second](int) {
            const auto now = values.find(name);
            const double value = photometry::number_of(now == values.end() ? before : now->second, false).value_or(0);
            values.insert_or_assign(name, std::to_string(adds ? value + by : value * by));
        });
    }

    void global(const XmlElement& holder) {
        for (const XmlElement& each : holder.children()) {
            if (each.name() == "InfrastructureAction")
                signals(each);
            else if (each.name() == "EnvironmentAction")
                environment(each);
            else if (each.name() == "ParameterAction" || each.name() == "VariableAction")
                setting(each);
            else if (!is_without_effect(each.name()))
                leave_out(each, "is no action that is known");
        }
    }

    void private_part(const XmlElement& holder) {
        for (const XmlElement& each : holder.children()) {
            const auto name = each.name();
            if (name == "AppearanceAction" || name == "RoutingAction" || name == "LongitudinalAction" ||
                name == "LateralAction")
                private_part(each);
            else if (name == "LightStateAction")
                lamp(each);
            else if (name == "TeleportAction")
                made.push_back({{},
                                [](RunEntity&, int) { return Progress{}; },
                                StoryAction::kLongitudinal | StoryAction::kLateral});
            else if (!is_without_effect(name))
                made.push_back(motion_of(each, scope, story));
        }
    }
};

}  // namespace

std::vector<StoryAction> actions_of(const XmlElement& holder, const Parameters& scope, StoryTime& story) {
    ActionReader reader{scope, story};
    for (const XmlElement& each : holder.children()) {
        if (each.name() == "GlobalAction")
            reader.global(each);
        else if (each.name() == "PrivateAction")
            reader.private_part(each);
        else if (each.name() != "UserDefinedAction" && each.name() != "Private")
            reader.leave_out(each, "is no action that is known");
    }
    return std::move(reader.made);
}

}  // namespace vesper::roads
