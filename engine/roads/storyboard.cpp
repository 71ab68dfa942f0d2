// The storyboard of a scenario, played over a recorded run. SPDX-License-Identifier: MIT
#include <algorithm>
#include <set>
#include <utility>

#include "roads/storyboard_actions.h"

namespace vesper::roads {
namespace {

constexpr size_t kMaxSteps = 2'000'000;
using Is = ElementState::Is;

/// An action of one actor that goes on.
struct UnderWay {
    Progress done;
    std::shared_ptr<bool> over;  ///< another one took its place
};

struct ActionPart {
    size_t index;
    std::vector<StoryAction> parts;
    std::vector<UnderWay> under_way{};
    bool running = false;
};

struct EventPart {
    size_t index;
    enum class Priority : uint8_t { Override, Skip, Parallel, None } priority;
    Trigger trigger;
    std::vector<ActionPart> actions{};
    int most = 1, executions = 0;
    bool running = false;
    bool done() const { return !running && executions >= most; }
};

struct ManeuverPart {
    size_t index;
    std::vector<EventPart> events{};
    std::set<EventPart*> running{};  ///< of these events
    bool complete = false;
};

struct GroupPart {
    size_t index;
    std::vector<RunEntity*> actors{};
    bool select = false;  ///< entities that trigger an event act in it, too
    std::vector<ManeuverPart> maneuvers{};
    bool complete = false;
};

struct ActPart {
    size_t index, story;
    Trigger start, stop;
    bool stops = false, running = false, complete = false;
    std::vector<GroupPart> groups{};
};

struct Player {
    ScenarioFile& scenario;
    StoryTime story;
    std::vector<ActPart> acts{};
    std::map<size_t, size_t> open{};                                             ///< acts not complete, by story
    std::map<std::pair<RunEntity*, uint32_t>, std::shared_ptr<bool>> current{};  ///< action of an actor, by its domain

    static std::string name_in(const XmlElement& element, const Parameters& scope) {
        return resolved(element, "name", scope).value_or("");
    }
    size_t add(ElementKind kind, const XmlElement& element, const Parameters& scope, size_t above) {
        return story.elements.add(kind, element, name_in(element, scope), above);
    }

    // Reading.

    EventPart event_of(const XmlElement& element, const Parameters& scope, const GroupPart& group, size_t above) {
        using Priority = EventPart::Priority;
        static const std::map<std::string, Priority> kPriorities{{"override", Priority::Override},
                                                                 {"overwrite", Priority::Override},
                                                                 {"skip", Priority::Skip},
                                                                 {"parallel", Priority::Parallel}};
        EventPart event{add(ElementKind::Event, element, scope, above), Priority::None, {}};
        const std::string priority = resolved(element, "priority", scope).value_or("override");
        const auto known = kPriorities.find(priority);
        if (known != kPriorities.end())
            event.priority = known->second;
        else
            story.note(element.place() + ": priority '" + priority + "' is none of OpenSCENARIO's: it never begins");
        const size_t before = story.questions;
        event.trigger = trigger_of(element.child("StartTrigger"), scope, story);
        event.trigger.select = group.select;
        const size_t actors = group.actors.size() + (group.select ? story.questions - before : 0);
        story.ask(actors);
        event.most = static_cast<int>(std::clamp(number_in(element, "maximumExecutionCount", scope, 1), 1.0, 1e6));
        for (const XmlElement& each : element.children("Action")) {
            ActionPart action{add(ElementKind::Action, each, scope, event.index), actions_of(each, scope, story)};
            for (const StoryAction& part : action.parts) {
                if (part.each && actors == 0) story.note(each.place() + ": there is no actor for it");
                story.ask(part.each ? actors * part.cost : 1);
            }
            event.actions.push_back(std::move(action));
        }
        return event;
    }

    void maneuver_in(GroupPart& group, const XmlElement& element, const Parameters& scope) {
        ManeuverPart maneuver{add(ElementKind::Maneuver, element, scope, group.index)};
        for (const XmlElement& each : element.children("Event"))
            maneuver.events.push_back(event_of(each, scope, group, maneuver.index));
        group.maneuvers.push_back(std::move(maneuver));
    }

    GroupPart group_of(const XmlElement& element, const Parameters& scope, size_t above) {
        GroupPart group{add(ElementKind::ManeuverGroup, element, scope, above)};
        if (const auto actors = element.child("Actors")) {
            group.select = flag_in(*actors, "selectTriggeringEntities", scope);
            for (const XmlElement& each : actors->children("EntityRef"))
                for (RunEntity* entity : story.all_of(each, "entityRef", scope))
                    group.actors.push_back(entity), story.ask(1);
        }
        each_once(group.actors);
        if (number_in(element, "maximumExecutionCount", scope, 1) > 1)
            story.note(element.place() + ": is gone through once");
        for (const XmlElement& each : element.children("Maneuver")) maneuver_in(group, each, declared(each, scope));
        for (const XmlElement& each : element.children("CatalogReference")) {
            const auto entry = scenario.find(each, scope);
            if (entry)
                maneuver_in(group, entry->element, entry->parameters);
            else
                story.note(each.place() + ": no catalog has this maneuver");
        }
        return group;
    }

    void init(const XmlElement& actions) {
        const Parameters& scope = scenario.parameters();
        const auto begin = [&](const std::vector<StoryAction>& parts, const std::vector<RunEntity*>& actors) {
            for (const StoryAction& part : parts) {
                story.ask(actors.size());
                if (part.once) part.once(0);
                for (RunEntity* actor : actors)
                    if (part.each) part.each(*actor, 0);
            }
        };
        begin(actions_of(actions, scope, story), {});
        for (const XmlElement& each : actions.children("Private"))
            begin(actions_of(each, scope, story), story.all_of(each, "entityRef", scope));
    }

    void read() {
        const Parameters& scope = scenario.parameters();
        for (const XmlElement& each : scenario.root().children_of("VariableDeclarations", "VariableDeclaration"))
            story.variables.insert_or_assign(name_in(each, scope), resolved(each, "value", scope).value_or(""));
        for (const XmlElement& network : scenario.root().children("RoadNetwork"))
            for (const XmlElement& each : network.children_of("TrafficSignals", "TrafficSignalController"))
                story.note(each.place() + ": controllers of traffic signals are not played: left out");
        story.find_places();
        for (const XmlElement& holder : story.storyboard.children("Init"))
            for (const XmlElement& actions : holder.children("Actions")) init(actions);
        for (const XmlElement& element : story.storyboard.children("Story")) {
            const size_t index = add(ElementKind::Story, element, scope, StoryElements::kNone);
            const Parameters inner = declared(element, scope);
            for (const XmlElement& each : element.children("Act")) {
                const auto stop = each.child("StopTrigger");
                ActPart act{add(ElementKind::Act, each, inner, index), index,
                            trigger_of(each.child("StartTrigger"), inner, story), trigger_of(stop, inner, story, false),
                            stop.has_value()};
                for (const XmlElement& group : each.children("ManeuverGroup"))
                    act.groups.push_back(group_of(group, inner, act.index));
                acts.push_back(std::move(act));
                ++open[index];
            }
        }
        story.find_references();
        story.ask(0);
    }

    // Playing.

    void end_action(ActionPart& action, int step) {
        if (action.running) story.elements.end(action.index, step);
        action.running = false;
        action.under_way.clear();
    }

    void end_event(EventPart& event, int step) {
        for (ActionPart& action : event.actions) end_action(action, step);
        event.running = false;
        story.elements.end(event.index, step, event.executions < event.most);
        event.trigger.forget();
    }

    void begin_part(ActionPart& action, const StoryAction& part, RunEntity& actor, int step) {
        Progress done = part.each(actor, step);
        const auto over = std::make_shared<bool>(false);
        for (uint32_t domain = 1; domain != 0; domain <<= 1) {
            if (!(part.domains & domain)) continue;
            std::shared_ptr<bool>& now = current[{&actor, domain}];
            if (now) *now = true;
            now = over;
        }
        if (done) action.under_way.push_back({std::move(done), over});
    }

    void begin_event(EventPart& event, ManeuverPart& maneuver, const GroupPart& group, int step) {
        event.running = true;
        maneuver.running.insert(&event);
        ++event.executions;
        story.elements.start(event.index, step);
        std::vector<RunEntity*> actors = group.actors;
        actors.insert(actors.end(), event.trigger.triggering.begin(), event.trigger.triggering.end());
        each_once(actors);
        for (ActionPart& action : event.actions) {
            action.running = true;
            story.elements.start(action.index, step);
            for (const StoryAction& part : action.parts) {
                if (part.once) part.once(step);
                for (RunEntity* actor : actors)
                    if (part.each) begin_part(action, part, *actor, step);
            }
        }
    }

    void step_event(EventPart& event, ManeuverPart& maneuver, const GroupPart& group, int step) {
        using Priority = EventPart::Priority;
        if (!event.running && event.executions < event.most && event.trigger.holds(step, story) &&
            event.priority != Priority::None) {
            if (event.priority == Priority::Skip && !maneuver.running.empty()) {
                story.elements[event.index].skipped = step;
                return;
            }
            if (event.priority == Priority::Override)
                for (EventPart* other : std::exchange(maneuver.running, {})) end_event(*other, step);
            begin_event(event, maneuver, group, step);
        }
        if (!event.running) return;
        bool all = true;
        for (ActionPart& action : event.actions) {
            std::erase_if(action.under_way, [&](UnderWay& each) { return *each.over || each.done(step); });
            if (action.under_way.empty()) end_action(action, step);
            all = all && !action.running;
        }
        if (!all) return;
        maneuver.running.erase(&event);
        end_event(event, step);
    }

    void start_act(ActPart& act, int step) {
        act.running = true;
        story.elements.start(act.index, step);
        for (GroupPart& group : act.groups) {
            story.elements.start(group.index, step);
            for (ManeuverPart& maneuver : group.maneuvers) {
                story.elements.start(maneuver.index, step);
                for (const EventPart& event : maneuver.events) story.elements[event.index].is = Is::Standby;
            }
        }
    }

    /// What it holds ends with it.
    void stop_act(ActPart& act, int step) {
        for (GroupPart& group : act.groups) {
            for (ManeuverPart& maneuver : group.maneuvers) {
                for (EventPart& event : maneuver.events) {
                    if (event.done()) continue;
                    event.executions = event.most;
                    end_event(event, step);
                }
                if (!std::exchange(maneuver.complete, true)) story.elements.end(maneuver.index, step);
            }
            if (!std::exchange(group.complete, true)) story.elements.end(group.index, step);
        }
    }

    void step_act(ActPart& act, int step) {
        if (act.complete) return;
        if (act.running && act.stops && act.stop.holds(step, story)) stop_act(act, step);
        if (!act.running) {
            if (!act.start.holds(step, story)) return;
            start_act(act, step);
        }
        bool all = true;
        for (GroupPart& group : act.groups) {
            bool group_done = true;
            for (ManeuverPart& maneuver : group.maneuvers) {
                if (maneuver.complete) continue;
                for (EventPart& event : maneuver.events) step_event(event, maneuver, group, step);
                maneuver.complete = std::all_of(maneuver.events.begin(), maneuver.events.end(),
                                                [](const EventPart& e) { return e.done(); });
                if (maneuver.complete) story.elements.end(maneuver.index, step);
                group_done = group_done && maneuver.complete;
            }
            if (group_done && !group.complete) group.complete = true, story.elements.end(group.index, step);
            all = all && group.complete;
        }
        if (!all) return;
        act.complete = true;
        story.elements.end(act.index, step);
        if (--open[act.story] == 0) story.elements.end(act.story, step);
    }

    void play() {
        for (const auto& [index, acts_of_it] : open) story.elements.start(index, 0);
        for (const ActPart& act : acts) story.elements[act.index].is = Is::Standby;
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
    Player player{scenario, StoryTime{run, roads, scenario, *storyboard, steps_of(run)}};
    if (player.story.times.size() > kMaxSteps)
        storyboard->fail("the run has more than " + std::to_string(kMaxSteps) + " steps");
    player.read();
    player.play();
    run.notes.insert(run.notes.end(), player.story.notes.begin(), player.story.notes.end());
}

}  // namespace vesper::roads
