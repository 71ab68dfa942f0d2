// Conditions of a storyboard. SPDX-License-Identifier: MIT
#include "roads/storyboard_conditions.h"

#include <algorithm>
#include <cmath>

#include "base/lower.h"
#include "roads/road_surface.h"

namespace vesper {
namespace {

using Compare = std::function<bool(double)>;

/// "lessThan 4" and its like.
Compare compare_with(const XmlElement& element, const Parameters& scope) {
    const double value = number_in(element, "value", scope, 0);
    const std::string rule = resolved(element, "rule", scope).value_or("greaterOrEqual");
    if (rule == "lessThan") return [=](double x) { return x < value; };
    if (rule == "lessOrEqual") return [=](double x) { return x <= value; };
    if (rule == "greaterThan") return [=](double x) { return x > value; };
    if (rule == "equalTo") return [=](double x) { return std::abs(x - value) < 1e-4; };
    if (rule == "notEqualTo") return [=](double x) { return std::abs(x - value) >= 1e-4; };
    if (rule != "greaterOrEqual") element.fail("rule '" + rule + "' is none of OpenSCENARIO's");
    return [=](double x) { return x >= value; };
}

std::optional<glm::dvec3> position_of(const XmlElement& element, const Parameters& scope, const StoryTime& time) {
    const auto holder = element.child("Position");
    if (!holder) return std::nullopt;
    if (const auto world = holder->child("WorldPosition"))
        return glm::dvec3{number_in(*world, "x", scope, 0), number_in(*world, "y", scope, 0),
                          number_in(*world, "z", scope, 0)};
    const auto lane = holder->child("LanePosition"), on_road = holder->child("RoadPosition");
    const auto& place = lane ? lane : on_road;
    if (!place || !time.roads) return std::nullopt;
    const auto id = resolved(*place, "roadId", scope);
    for (const Road& road : time.roads->roads) {
        if (!id || road.id != *id || road.sections.empty()) continue;
        const double s = std::clamp(number_in(*place, "s", scope, 0), 0.0, road.length);
        if (!lane) return surface_point(road, s, number_in(*place, "t", scope, 0)).position;
        const LaneSection& section = road.sections[road.section_at(s)];
        const int number = static_cast<int>(number_in(*place, "laneId", scope, 0));
        if (!section.find(number)) return std::nullopt;
        const RoadPoint point = lane_point(road, section, number, s, 0.5);
        return point.position + point.left * number_in(*place, "offset", scope, 0);
    }
    return std::nullopt;
}

double flat_distance(glm::dvec3 a, glm::dvec3 b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// Metres between two entities: their reference points, or what is free between their boxes.
double gap(const RunEntity& a, const RunEntity& b, double time, bool free_space) {
    const double distance = flat_distance(pose_at(a, time).position, pose_at(b, time).position);
    return free_space ? std::max(0.0, distance - (a.length + b.length) / 2) : distance;
}

struct ConditionReader {
    StoryTime& story;
    const Parameters& scope;

    const RunEntity* entity(const XmlElement& element, const char* attribute = "entityRef") {
        const auto name = resolved(element, attribute, scope);
        return name ? story.find(*name) : nullptr;
    }
    double at(int step) const { return story.times[static_cast<size_t>(step)]; }

    std::optional<Condition> by_value(const XmlElement& element) {
        if (element.name() == "SimulationTimeCondition")
            return [compare = compare_with(element, scope), &story = story](int step) {
                return compare(story.times[static_cast<size_t>(step)]);
            };
        if (element.name() == "StoryboardElementStateCondition") return element_state(element);
        if (element.name() == "TrafficSignalCondition") {
            const std::string name = resolved(element, "name", scope).value_or(""),
                              state = resolved(element, "state", scope).value_or("");
            return [&story = story, name, state](int) {
                const auto now = story.signals.find(name);
                return now != story.signals.end() && now->second == state;
            };
        }
        if (element.name() == "ParameterCondition") {
            const auto found = scope.find(element.text_or("parameterRef", ""));
            const bool same = found != scope.end() && found->second == resolved(element, "value", scope).value_or("");
            return [same](int) { return same; };
        }
        return std::nullopt;
    }

    Condition element_state(const XmlElement& element) {
        const std::string kind = lower(resolved(element, "storyboardElementType", scope).value_or("event"));
        std::string name = resolved(element, "storyboardElementRef", scope).value_or("");
        // References may be paths: the last part counts.
        if (const size_t colon = name.rfind("::"); colon != name.npos) name = name.substr(colon + 2);
        const std::string state = resolved(element, "state", scope).value_or("completeState"), key = kind + "/" + name;
        return [&story = story, key, state](int step) {
            const ElementState& now = story.elements[key];
            if (state == "startTransition") return now.started >= step - 1 && now.started >= 0;
            if (state == "endTransition" || state == "stopTransition") return now.ended >= step - 1 && now.ended >= 0;
            if (state == "runningState") return now.running > 0;
            if (state == "completeState") return now.ended >= 0 && now.running == 0;
            if (state == "standbyState") return now.started < 0;
            return false;
        };
    }

    /// A condition on one triggering entity.
    std::optional<std::function<bool(const RunEntity&, int)>> by_entity(const XmlElement& element) {
        const auto name = element.name();
        const bool free_space = element.flag("freespace");
        StoryTime& s = story;
        const auto now = [&s](int step) { return s.times[static_cast<size_t>(step)]; };
        if (name == "SpeedCondition")
            return [compare = compare_with(element, scope), now](const RunEntity& e, int step) {
                return compare(pose_at(e, now(step)).speed);
            };
        if (name == "TraveledDistanceCondition") {
            const double value = number_in(element, "value", scope, 0);
            struct Way {
                size_t at = 0;
                double sum = 0;
            };
            auto ways = std::make_shared<std::map<const RunEntity*, Way>>();
            return [value, now, ways](const RunEntity& e, int step) {
                Way& way = (*ways)[&e];
                for (; way.at + 1 < e.poses.size() && e.poses[way.at + 1].time <= now(step); ++way.at)
                    way.sum += glm::distance(e.poses[way.at].position, e.poses[way.at + 1].position);
                return way.sum >= value;
            };
        }
        if (name == "StandStillCondition") {
            const double duration = number_in(element, "duration", scope, 0);
            struct Rest {
                size_t at = 0;
                double moved = -HUGE_VAL;  ///< time it last moved
            };
            auto rests = std::make_shared<std::map<const RunEntity*, Rest>>();
            return [duration, now, rests](const RunEntity& e, int step) {
                Rest& rest = (*rests)[&e];
                for (; rest.at < e.poses.size() && e.poses[rest.at].time <= now(step); ++rest.at)
                    if (std::abs(e.poses[rest.at].speed) > 0.01) rest.moved = e.poses[rest.at].time;
                return rest.moved < now(step) - duration && now(step) - e.poses.front().time >= duration;
            };
        }
        if (name == "AccelerationCondition")
            return [compare = compare_with(element, scope), now](const RunEntity& e, int step) {
                const double before = now(step) - 0.1;
                return compare((pose_at(e, now(step)).speed - pose_at(e, before).speed) / 0.1);
            };
        if (name == "TimeHeadwayCondition" || name == "RelativeDistanceCondition" || name == "RelativeSpeedCondition") {
            const RunEntity* other = entity(element);
            if (!other) return std::nullopt;
            const auto compare = compare_with(element, scope);
            if (name == "RelativeSpeedCondition")
                return [=](const RunEntity& e, int step) {
                    return compare(pose_at(e, now(step)).speed - pose_at(*other, now(step)).speed);
                };
            const bool headway = name == "TimeHeadwayCondition";
            return [=](const RunEntity& e, int step) {
                const double distance = gap(e, *other, now(step), free_space),
                             speed = std::abs(pose_at(e, now(step)).speed);
                return compare(!headway ? distance : speed > 1e-3 ? distance / speed : 1e9);
            };
        }
        if (name == "TimeToCollisionCondition") {
            const auto target = element.child("TimeToCollisionConditionTarget");
            const auto reference = target ? target->child("EntityRef") : std::nullopt;
            const RunEntity* other = reference ? entity(*reference) : nullptr;
            if (!other) return std::nullopt;
            return [compare = compare_with(element, scope), other, free_space, now](const RunEntity& e, int step) {
                const double before = now(step) - 0.1,
                             closing = (gap(e, *other, before, false) - gap(e, *other, now(step), false)) / 0.1;
                return compare(closing > 1e-3 ? gap(e, *other, now(step), free_space) / closing : 1e9);
            };
        }
        if (name == "ReachPositionCondition" || name == "DistanceCondition") {
            const auto place = position_of(element, scope, story);
            if (!place) return std::nullopt;
            const double tolerance = number_in(element, "tolerance", scope, 1);
            const bool reach = name == "ReachPositionCondition";
            const Compare compare =
                reach ? Compare([tolerance](double d) { return d <= tolerance; }) : compare_with(element, scope);
            return [=](const RunEntity& e, int step) {
                return compare(flat_distance(pose_at(e, now(step)).position, *place));
            };
        }
        return std::nullopt;
    }

    std::optional<Condition> entity_condition(const XmlElement& element) {
        std::vector<const RunEntity*> who;
        for (const XmlElement& each : element.children_of("TriggeringEntities", "EntityRef"))
            if (const RunEntity* found = entity(each)) who.push_back(found);
        const auto triggering = element.child("TriggeringEntities"), holder = element.child("EntityCondition");
        if (who.empty() || !triggering || !holder || holder->children().empty()) return std::nullopt;
        const auto test = by_entity(holder->children()[0]);
        if (!test) return std::nullopt;
        story.questions += who.size();
        const bool all = triggering->text_or("triggeringEntitiesRule", "any") == "all";
        return [=](int step) {
            const auto holds = [&](const RunEntity* e) { return (*test)(*e, step); };
            return all ? std::all_of(who.begin(), who.end(), holds) : std::any_of(who.begin(), who.end(), holds);
        };
    }

    Condition plain(const XmlElement& element) {
        std::optional<Condition> made;
        std::string what;
        if (const auto value = element.child("ByValueCondition"); value && !value->children().empty()) {
            what = value->children()[0].name();
            made = by_value(value->children()[0]);
        } else if (const auto entities = element.child("ByEntityCondition")) {
            const auto inner = entities->child("EntityCondition");
            what = inner && !inner->children().empty() ? inner->children()[0].name() : "ByEntityCondition";
            made = entity_condition(*entities);
        }
        if (made) return *made;
        story.note(element.place() + ": " +
                   (what.empty() ? "an empty condition" : "a " + what + " that cannot be judged") + ": it never holds");
        return [](int) { return false; };
    }

    /// With its delay and edge: what it says was so `delay` ago.
    Condition delayed(const XmlElement& element) {
        ++story.questions;
        const double delay = number_in(element, "delay", scope, 0);
        const std::string edge = resolved(element, "conditionEdge", scope).value_or("none");
        auto history = std::make_shared<std::vector<char>>();
        auto seen = std::make_shared<size_t>(0);
        return [test = plain(element), delay, edge, history, seen, &story = story](int step) {
            const auto i = static_cast<size_t>(step);
            while (history->size() < i) history->push_back(0);
            history->push_back(test(step));
            const auto value_at = [&](size_t k) {
                const bool now = (*history)[k] != 0, before = k > 0 && (*history)[k - 1] != 0;
                if (edge == "rising") return now && !before && k > 0;
                if (edge == "falling") return !now && before;
                if (edge == "risingOrFalling") return k > 0 && now != before;
                return now;
            };
            if (delay <= 0) return value_at(i);
            // Any step that has become old enough since the last time.
            bool held = false;
            for (; *seen <= i && story.times[*seen] <= story.times[i] - delay + 1e-6; ++*seen)
                held = held || value_at(*seen);
            return held;
        };
    }
};

}  // namespace

const RunEntity* StoryTime::find(const std::string& name) const {
    const auto found =
        std::find_if(run.entities.begin(), run.entities.end(), [&](const RunEntity& e) { return e.name == name; });
    return found == run.entities.end() ? nullptr : &*found;
}

void StoryTime::note(const std::string& what) {
    if (notes.size() < 50 && std::find(notes.begin(), notes.end(), what) == notes.end()) notes.push_back(what);
}

Condition trigger_of(const std::optional<XmlElement>& trigger, const Parameters& scope, StoryTime& time) {
    if (!trigger) return [](int) { return true; };
    std::vector<std::vector<Condition>> groups;
    ConditionReader reader{time, scope};
    for (const XmlElement& group : trigger->children("ConditionGroup")) {
        groups.emplace_back();
        for (const XmlElement& each : group.children("Condition")) groups.back().push_back(reader.delayed(each));
    }
    return [groups](int step) {
        bool any = groups.empty();
        for (const auto& group : groups) {
            bool all = true;
            for (const Condition& each : group) all = each(step) && all;  // every one is asked every step
            any = any || all;
        }
        return any;
    };
}

}  // namespace vesper
