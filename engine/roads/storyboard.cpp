// The storyboard of a scenario, played over a recorded run. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "base/error.h"
#include "roads/storyboard_conditions.h"

namespace vesper {
namespace {

constexpr size_t kMaxSteps = 2'000'000, kMaxElements = 20'000;
constexpr double kMaxWork = 5e8;  // elements and questions of conditions, times steps

struct ActionPart {
    std::string name;
    XmlElement element;
    double end = 0;  ///< time it is done at, once started
};

struct EventPart {
    std::string name, priority;
    Parameters scope;
    Condition trigger;
    std::vector<ActionPart> actions;
    int most = 1, executions = 0;
    bool running = false;
    bool done() const { return !running && executions >= most; }
};

struct ManeuverPart {
    std::string name;
    std::vector<EventPart> events;
    std::set<EventPart*> running{};  ///< of these events
    bool complete = false;
};

struct GroupPart {
    std::string name;
    std::vector<std::string> actors;
    std::vector<ManeuverPart> maneuvers;
    bool complete = false;
};

struct ActPart {
    std::string name;
    Condition start, stop;
    bool stops = false, running = false, complete = false;
    std::vector<GroupPart> groups;
};

struct Player {
    ScenarioFile& scenario;
    EsminiRun& run;
    StoryTime story;
    std::vector<ActPart> acts{};
    size_t elements = 0;

    void count(const XmlElement& element) {
        if (++elements > kMaxElements)
            element.fail("the storyboard has more than " + std::to_string(kMaxElements) + " elements");
    }

    // What actions do.

    void set_lamp(const XmlElement& element, const Parameters& scope, const std::vector<std::string>& actors,
                  double time) {
        const auto type = element.child("LightType"), state = element.child("LightState");
        const auto vehicle = type ? type->child("VehicleLight") : std::nullopt;
        if (!vehicle || !state) return story.note(element.place() + ": no vehicle light: left out");
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
        const auto lamps = kLamps.find(name);
        if (lamps == kLamps.end()) return story.note(vehicle->place() + ": there is no light '" + name + "'");
        LampEvent event{.time = time};
        const std::string mode = resolved(*state, "mode", scope).value_or("on");
        event.mode = mode == "off"        ? LampEvent::Mode::Off
                     : mode == "flashing" ? LampEvent::Mode::Flashing
                                          : LampEvent::Mode::On;
        event.transition = std::clamp(number_in(element, "transitionTime", scope, 0), 0.0, 3600.0);
        event.on_time = std::clamp(number_in(*state, "flashingOnDuration", scope, 0.5), 0.0, 3600.0);
        event.off_time = std::clamp(number_in(*state, "flashingOffDuration", scope, 0.5), 0.0, 3600.0);
        event.intensity = std::max(0.0, number_in(*state, "luminousIntensity", scope, 0));
        if (const auto colour = state->child("Color"))
            if (const auto rgb = colour->child("ColorRgb"))
                event.colour = glm::dvec3{number_in(*rgb, "red", scope, 0), number_in(*rgb, "green", scope, 0),
                                          number_in(*rgb, "blue", scope, 0)};
        for (RunEntity& entity : run.entities) {
            if (std::find(actors.begin(), actors.end(), entity.name) == actors.end()) continue;
            for (const RunLamp lamp : lamps->second) {
                entity.lamps[static_cast<size_t>(lamp)].push_back(event);
                entity.stated[static_cast<size_t>(lamp)] = true;
            }
        }
    }

    void global(const XmlElement& element, const Parameters& scope, double time) {
        for (const XmlElement& infrastructure : element.children("InfrastructureAction"))
            for (const XmlElement& each :
                 infrastructure.children_of("TrafficSignalAction", "TrafficSignalStateAction")) {
                const std::string name = resolved(each, "name", scope).value_or(""),
                                  state = resolved(each, "state", scope).value_or("");
                run.signals.push_back({time, name, state, each.place()});
                story.signals[name] = state;
            }
        for (const XmlElement& environment : element.children_of("EnvironmentAction", "Environment"))
            if (const auto when = environment.child("TimeOfDay"))
                run.time_of_day.push_back({time, "", resolved(*when, "dateTime", scope).value_or("")});
    }

    /// Does what the action does to lamps and signals, and says how long it takes.
    double start(const XmlElement& action, const Parameters& scope, const std::vector<std::string>& actors,
                 double time) {
        for (const XmlElement& each : action.children("GlobalAction")) global(each, scope, time);
        double longest = 0;
        for (const XmlElement& part : action.children("PrivateAction")) {
            for (const XmlElement& light : part.children_of("AppearanceAction", "LightStateAction"))
                set_lamp(light, scope, actors, time);
            longest = std::max(longest, duration_of(part, scope, actors, time));
        }
        return longest;
    }

    double duration_of(const XmlElement& part, const Parameters& scope, const std::vector<std::string>& actors,
                       double time) {
        for (const char* group : {"LongitudinalAction", "LateralAction"})
            for (const XmlElement& holder : part.children(group))
                for (const XmlElement& action : holder.children())
                    for (const XmlElement& each : action.children()) {
                        if (!each.name().ends_with("Dynamics") || !each.attribute("dynamicsDimension")) continue;
                        return dynamics(each, action, scope, actors, time);
                    }
        return 0;
    }

    double dynamics(const XmlElement& element, const XmlElement& action, const Parameters& scope,
                    const std::vector<std::string>& actors, double time) {
        const std::string shape = resolved(element, "dynamicsShape", scope).value_or("");
        if (shape == "step") return 0;
        const double value = std::abs(number_in(element, "value", scope, 0));
        const std::string dimension = resolved(element, "dynamicsDimension", scope).value_or("time");
        const RunEntity* actor = actors.empty() ? nullptr : story.find(actors[0]);
        const double speed = actor ? pose_at(*actor, time).speed : 0;
        const auto targets = action.children_of("SpeedActionTarget", "AbsoluteTargetSpeed");
        const double change = targets.empty() ? 0 : number_in(targets[0], "value", scope, 0) - speed;
        if (dimension == "distance") return std::abs(speed) > 0.1 ? value / std::abs(speed) : 0;
        if (dimension == "rate") return value > 0 ? std::abs(change) / value : 0;
        // As esmini does: a vehicle takes as long as its strongest acceleration asks for.
        const double most = !actor ? 0 : change > 0 ? actor->acceleration : actor->deceleration;
        const double peak = shape == "sinusoidal" ? std::numbers::pi / 2 : shape == "cubic" ? 1.5 : 1;
        return most > 0 ? std::max(value, peak * std::abs(change) / most) : value;
    }

    // Reading.

    EventPart event_of(const XmlElement& element, const Parameters& scope) {
        count(element);
        EventPart event{element.text_or("name", ""),
                        element.text_or("priority", "override"),
                        scope,
                        trigger_of(element.child("StartTrigger"), scope, story),
                        {}};
        event.most = static_cast<int>(std::clamp(number_in(element, "maximumExecutionCount", scope, 1), 1.0, 1e6));
        for (const XmlElement& each : element.children("Action")) {
            count(each);
            event.actions.push_back({each.text_or("name", ""), each});
        }
        return event;
    }

    ManeuverPart maneuver_of(const XmlElement& element, const Parameters& around) {
        count(element);
        const Parameters scope = declared(element, around);
        return maneuver_in(element, scope);
    }
    ManeuverPart maneuver_in(const XmlElement& element, const Parameters& scope) {
        ManeuverPart maneuver{element.text_or("name", ""), {}};
        for (const XmlElement& each : element.children("Event")) maneuver.events.push_back(event_of(each, scope));
        return maneuver;
    }

    GroupPart group_of(const XmlElement& element, const Parameters& scope) {
        GroupPart group{element.text_or("name", ""), {}, {}};
        for (const XmlElement& each : element.children_of("Actors", "EntityRef"))
            if (const auto name = resolved(each, "entityRef", scope)) group.actors.push_back(*name);
        for (const XmlElement& each : element.children("Maneuver")) group.maneuvers.push_back(maneuver_of(each, scope));
        for (const XmlElement& each : element.children("CatalogReference")) {
            const auto entry = scenario.find(each, scope);
            if (entry)
                group.maneuvers.push_back(maneuver_in(entry->element, entry->parameters));
            else
                story.note(each.place() + ": no catalog has this maneuver");
        }
        return group;
    }

    void read(const XmlElement& storyboard) {
        const Parameters& scope = scenario.parameters();
        for (const XmlElement& init : storyboard.children("Init"))
            for (const XmlElement& actions : init.children("Actions")) {
                for (const XmlElement& each : actions.children("GlobalAction")) global(each, scope, 0);
                for (const XmlElement& each : actions.children("Private"))
                    start(each, scope, {resolved(each, "entityRef", scope).value_or("")}, story.times.front());
            }
        for (const XmlElement& element : storyboard.children("Story")) {
            const Parameters inner = declared(element, scope);
            for (const XmlElement& each : element.children("Act")) {
                ActPart act{each.text_or("name", ""), trigger_of(each.child("StartTrigger"), inner, story),
                            trigger_of(each.child("StopTrigger"), inner, story)};
                const auto stop = each.child("StopTrigger");
                act.stops = stop && !stop->children("ConditionGroup").empty();
                for (const XmlElement& group : each.children("ManeuverGroup"))
                    act.groups.push_back(group_of(group, inner));
                acts.push_back(std::move(act));
            }
        }
    }

    // Playing.

    void mark_start(const std::string& key, int step) {
        ElementState& state = story.elements[key];
        state.started = step;
        ++state.running;
    }
    void mark_end(const std::string& key, int step) {
        ElementState& state = story.elements[key];
        state.ended = step;
        state.running = std::max(0, state.running - 1);
    }

    void end_event(EventPart& event, int step) {
        for (const ActionPart& action : event.actions)
            if (action.end >= 0) mark_end("action/" + action.name, step);
        event.running = false;
        mark_end("event/" + event.name, step);
    }

    void step_event(EventPart& event, ManeuverPart& maneuver, const GroupPart& group, int step) {
        const double time = story.times[static_cast<size_t>(step)];
        const bool triggered = event.trigger(step);
        if (!event.running && event.executions < event.most && triggered) {
            if (event.priority == "override" || event.priority == "overwrite")
                for (EventPart* other : std::exchange(maneuver.running, {})) end_event(*other, step);
            if (event.priority == "skip" && !maneuver.running.empty()) return;
            event.running = true;
            maneuver.running.insert(&event);
            ++event.executions;
            mark_start("event/" + event.name, step);
            for (ActionPart& action : event.actions) {
                mark_start("action/" + action.name, step);
                action.end = time + start(action.element, event.scope, group.actors, time);
            }
        }
        if (!event.running) return;
        bool all = true;
        for (ActionPart& action : event.actions) {
            if (action.end < 0) continue;
            if (time >= action.end - 1e-6) {
                mark_end("action/" + action.name, step);
                action.end = -1;
            } else {
                all = false;
            }
        }
        if (!all) return;
        maneuver.running.erase(&event);
        event.running = false;
        mark_end("event/" + event.name, step);
    }

    void step_act(ActPart& act, int step) {
        if (act.complete) return;
        if (!act.running) {
            if (!act.start(step)) return;
            act.running = true;
            mark_start("act/" + act.name, step);
            for (GroupPart& group : act.groups) {
                mark_start("maneuvergroup/" + group.name, step);
                for (ManeuverPart& maneuver : group.maneuvers) mark_start("maneuver/" + maneuver.name, step);
            }
        }
        bool all = true;
        for (GroupPart& group : act.groups) {
            bool group_done = true;
            for (ManeuverPart& maneuver : group.maneuvers) {
                if (maneuver.complete) continue;
                for (EventPart& event : maneuver.events) step_event(event, maneuver, group, step);
                maneuver.complete = std::all_of(maneuver.events.begin(), maneuver.events.end(),
                                                [](const EventPart& e) { return e.done(); });
                if (maneuver.complete) mark_end("maneuver/" + maneuver.name, step);
                group_done = group_done && maneuver.complete;
            }
            if (group_done && !group.complete) group.complete = true, mark_end("maneuvergroup/" + group.name, step);
            all = all && group.complete;
        }
        if (all || (act.stops && act.stop(step))) act.complete = true, mark_end("act/" + act.name, step);
    }

    void play() {
        for (size_t step = 0; step < story.times.size(); ++step)
            for (ActPart& act : acts) step_act(act, static_cast<int>(step));
    }
};

/// The times of all rows, each once.
std::vector<double> steps_of(const EsminiRun& run) {
    std::vector<double> times;
    for (const RunEntity& entity : run.entities)
        for (const RunPose& pose : entity.poses) times.push_back(pose.time);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

}  // namespace

void play_storyboard(ScenarioFile& scenario, const RoadNetwork* roads, EsminiRun& run) {
    const auto storyboard = scenario.root().child("Storyboard");
    if (!storyboard) return;
    Player player{scenario, run, StoryTime{run, roads, steps_of(run)}};
    if (player.story.times.size() > kMaxSteps) storyboard->fail("the run has more than " + std::to_string(kMaxSteps) + " steps");
    player.read(*storyboard);
    const double asked = static_cast<double>(player.elements + player.story.questions);
    if (asked * static_cast<double>(player.story.times.size()) > kMaxWork)
        storyboard->fail("too many elements and conditions for so long a run");
    player.play();
    run.notes.insert(run.notes.end(), player.story.notes.begin(), player.story.notes.end());
}

}  // namespace vesper
