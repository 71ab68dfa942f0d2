// Conditions of a storyboard. SPDX-License-Identifier: MIT
#include "roads/storyboard_conditions.h"

#include <algorithm>
#include <cmath>

#include "base/lower.h"
#include "photometry/table.h"
#include "roads/storyboard_places.h"

namespace vesper::roads {
namespace {

enum class Rule : uint8_t { Less, LessOrEqual, Equal, NotEqual, GreaterOrEqual, Greater };

Rule rule_of(const XmlElement& element, const Parameters& scope) {
    const std::string rule = resolved(element, "rule", scope).value_or("greaterOrEqual");
    if (rule == "lessThan") return Rule::Less;
    if (rule == "lessOrEqual") return Rule::LessOrEqual;
    if (rule == "greaterThan") return Rule::Greater;
    if (rule == "equalTo") return Rule::Equal;
    if (rule == "notEqualTo") return Rule::NotEqual;
    if (rule != "greaterOrEqual") element.fail("rule '" + rule + "' is none of OpenSCENARIO's");
    return Rule::GreaterOrEqual;
}

/// `order`: below 0 where the first is less than the second.
bool is_so(Rule rule, int order) {
    if (rule == Rule::Less) return order < 0;
    if (rule == Rule::LessOrEqual) return order <= 0;
    if (rule == Rule::Equal) return order == 0;
    if (rule == Rule::NotEqual) return order != 0;
    return rule == Rule::Greater ? order > 0 : order >= 0;
}

/// Numbers are the same within what esmini neglects, and equal within what tables round.
bool is_so(Rule rule, double a, double b) {
    const double same = rule == Rule::Equal || rule == Rule::NotEqual ? 1e-4 : 1e-6;
    return is_so(rule, std::abs(a - b) < same ? 0 : a < b ? -1 : 1);
}

bool is_so(Rule rule, const std::string& a, const std::string& b) {
    const auto x = photometry::number_of(a, false), y = photometry::number_of(b, false);
    return x && y ? is_so(rule, *x, *y) : is_so(rule, a.compare(b));
}

/// "lessThan 4" and its like.
std::function<bool(double)> compare_with(const XmlElement& element, const Parameters& scope) {
    return [value = number_in(element, "value", scope, 0), rule = rule_of(element, scope)](double x) {
        return is_so(rule, x, value);
    };
}

using Test = std::function<bool(int step)>;
using EntityTest = std::function<bool(const RunEntity&, int step)>;

struct ConditionReader {
    StoryTime& story;
    const Parameters& scope;

    std::optional<Test> by_value(const XmlElement& element) {
        StoryTime& s = story;
        if (element.name() == "SimulationTimeCondition")
            return [compare = compare_with(element, scope), &s](int step) { return compare(s.at(step)); };
        if (element.name() == "StoryboardElementStateCondition") return element_state(element);
        if (element.name() == "TrafficSignalCondition") {
            const std::string name = resolved(element, "name", scope).value_or(""),
                              state = resolved(element, "state", scope).value_or("");
            return [&s, name, state](int) {
                const auto now = s.signals.find(name);
                return now != s.signals.end() && now->second == state;
            };
        }
        const bool variable = element.name() == "VariableCondition";
        if (!variable && element.name() != "ParameterCondition") return std::nullopt;
        std::string name = element.text_or(variable ? "variableRef" : "parameterRef", "");
        if (name.starts_with('$')) name.erase(0, 1);
        const auto found = scope.find(name);
        if (variable ? !s.variables.contains(name) : found == scope.end()) return std::nullopt;
        const std::string around = variable ? "" : found->second,
                          value = resolved(element, "value", scope).value_or("");
        return
            [&now = variable ? s.variables : s.parameters, name, around, value, rule = rule_of(element, scope)](int) {
                const auto set = now.find(name);
                return is_so(rule, set == now.end() ? around : set->second, value);
            };
    }

    std::optional<Test> element_state(const XmlElement& element) {
        using State = ElementState;
        static const std::map<std::string, ElementKind> kKinds{{"story", ElementKind::Story},
                                                               {"act", ElementKind::Act},
                                                               {"maneuvergroup", ElementKind::ManeuverGroup},
                                                               {"maneuver", ElementKind::Maneuver},
                                                               {"event", ElementKind::Event},
                                                               {"action", ElementKind::Action}};
        static const std::map<std::string, bool (*)(const State&, int)> kStates{
            {"startTransition", [](const State& now, int step) { return now.started >= 0 && now.started >= step - 1; }},
            {"endTransition", [](const State& now, int step) { return now.ended >= 0 && now.ended >= step - 1; }},
            {"stopTransition", [](const State& now, int step) { return now.ended >= 0 && now.ended >= step - 1; }},
            {"skipTransition", [](const State& now, int step) { return now.skipped >= 0 && now.skipped >= step - 1; }},
            {"standbyState", [](const State& now, int) { return now.is == State::Is::Standby; }},
            {"runningState", [](const State& now, int) { return now.is == State::Is::Running; }},
            {"completeState", [](const State& now, int) { return now.is == State::Is::Complete; }}};
        const auto kind = kKinds.find(lower(resolved(element, "storyboardElementType", scope).value_or("event")));
        const auto state = kStates.find(resolved(element, "state", scope).value_or("completeState"));
        std::string name = resolved(element, "storyboardElementRef", scope).value_or("");
        if (kind == kKinds.end() || state == kStates.end() || name.size() > StoryElements::kMaxPath)
            return std::nullopt;
        const auto index = std::make_shared<size_t>(StoryElements::kNone);
        story.references.push_back({kind->second, std::move(name), element.place(), index});
        return [&elements = story.elements, index, is = state->second](int step) {
            return *index != StoryElements::kNone && is(elements[*index], step);
        };
    }

    std::optional<EntityTest> by_entity(const XmlElement& element) {
        const auto name = element.name();
        StoryTime& s = story;
        if (name == "SpeedCondition")
            return [compare = compare_with(element, scope), &s](const RunEntity& e, int step) {
                return compare(pose_at(e, s.at(step)).speed);
            };
        if (name == "TraveledDistanceCondition") {
            const double value = number_in(element, "value", scope, 0);
            struct Way {
                size_t at = 0;
                double sum = 0;
            };
            auto ways = std::make_shared<std::map<const RunEntity*, Way>>();
            return [value, &s, ways](const RunEntity& e, int step) {
                Way& way = (*ways)[&e];
                for (; way.at + 1 < e.poses.size() && e.poses[way.at + 1].time <= s.at(step); ++way.at)
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
            return [duration, &s, rests](const RunEntity& e, int step) {
                Rest& rest = (*rests)[&e];
                for (; rest.at < e.poses.size() && e.poses[rest.at].time <= s.at(step); ++rest.at)
                    if (std::abs(e.poses[rest.at].speed) > 0.01) rest.moved = e.poses[rest.at].time;
                return rest.moved < s.at(step) - duration && s.at(step) - e.poses.front().time >= duration;
            };
        }
        if (name == "AccelerationCondition")
            return [compare = compare_with(element, scope), &s](const RunEntity& e, int step) {
                const double before = s.at(step) - 0.1;
                return compare((pose_at(e, s.at(step)).speed - pose_at(e, before).speed) / 0.1);
            };
        if (name == "ReachPositionCondition") {
            const auto place = position_of(element, scope, story);
            if (!place) return std::nullopt;
            return [measure = Measure{}, tolerance = number_in(element, "tolerance", scope, 1),
                    to = StoryBox::of(*place), &s](const RunEntity& e, int step) {
                return std::abs(measure.distance(StoryBox::of(e, s.at(step)), to)) <= tolerance;
            };
        }
        return towards(element);
    }

    /// What conditions measure to: an entity, which may not be there, or a position.
    using Target = std::function<std::optional<StoryBox>(double time)>;
    std::optional<Target> target_of(const XmlElement& element) {
        const auto inside = element.child("TimeToCollisionConditionTarget");
        const auto inner = inside ? inside->child("EntityRef") : std::nullopt;
        const XmlElement& named = inner ? *inner : element;
        if (named.attribute("entityRef")) {
            const RunEntity* other = story.one_of(named, "entityRef", scope);
            if (!other) return std::nullopt;
            return [other](double time) {
                return is_there(*other, time) ? std::optional(StoryBox::of(*other, time)) : std::nullopt;
            };
        }
        const auto place = position_of(inside ? *inside : element, scope, story);
        if (!place) return std::nullopt;
        return [to = StoryBox::of(*place)](double) { return to; };
    }

    /// Conditions on a distance or a relative speed.
    std::optional<EntityTest> towards(const XmlElement& element) {
        const auto name = element.name();
        const bool to_entity =
            name == "RelativeDistanceCondition" || name == "TimeHeadwayCondition" || name == "RelativeSpeedCondition";
        if (!to_entity && name != "DistanceCondition" && name != "TimeToCollisionCondition") return std::nullopt;
        const auto target = target_of(element);
        if (!target) return std::nullopt;
        const Measure measure = measure_of(element, scope, story);
        const auto compare = compare_with(element, scope);
        std::function<bool(const StoryBox&, const StoryBox&)> test;
        constexpr double kNone = 1e-6;  // m, m/s
        if (name == "RelativeSpeedCondition")
            test = [=](const StoryBox& e, const StoryBox& other) { return compare(e.speed - other.speed); };
        else if (name == "TimeHeadwayCondition")
            test = [=](const StoryBox& e, const StoryBox& other) {
                const double distance = measure.distance(e, other);
                return distance >= 0 && e.speed >= kNone && compare(distance / e.speed);
            };
        else if (name == "TimeToCollisionCondition")
            test = [=](const StoryBox& e, const StoryBox& other) {
                // As esmini: how much faster it is along the other's way.
                const double along = e.speed * glm::dot(e.ahead, other.ahead) * (other.speed < 0 ? -1 : 1);
                const double closing = std::abs(other.speed) < kNone ? e.speed
                                                                     : (e.speed < 0 ? -1 : 1) * (along < 0 ? -1 : 1) *
                                                                           (along - std::abs(other.speed));
                const double distance = measure.distance(e, other);
                return std::abs(distance) >= kNone && std::abs(closing) >= kNone && distance / closing >= 0 &&
                       compare(distance / closing);
            };
        else
            test = [=](const StoryBox& e, const StoryBox& other) {
                return compare(std::abs(measure.distance(e, other)));
            };
        return [test, to = *target, &s = story](const RunEntity& e, int step) {
            const auto other = to(s.at(step));
            return other && test(StoryBox::of(e, s.at(step)), *other);
        };
    }

    std::optional<decltype(TimedCondition::test)> entity_condition(const XmlElement& element) {
        const auto triggering = element.child("TriggeringEntities"), holder = element.child("EntityCondition");
        if (!triggering || !holder || holder->children().empty()) return std::nullopt;
        const bool all = resolved(*triggering, "triggeringEntitiesRule", scope).value_or("any") == "all";
        std::vector<RunEntity*> who;
        for (const XmlElement& each : triggering->children("EntityRef")) {
            const auto found = story.all_of(each, "entityRef", scope);
            if (found.empty() && all) return std::nullopt;
            who.insert(who.end(), found.begin(), found.end());
            story.ask(found.size());
        }
        const auto test = by_entity(holder->children()[0]);
        if (who.empty() || !test) return std::nullopt;
        // Entities that are not there are not asked.
        return [who, all, test = *test, &s = story](int step, std::vector<RunEntity*>* held) {
            bool any = false;
            for (RunEntity* e : who) {
                if (!is_there(*e, s.at(step))) continue;
                const bool holds = test(*e, step);
                if (holds && held) held->push_back(e);
                if (all && !holds) return false;
                any = any || holds;
                if (any && !all && !held) return true;
            }
            return any;
        };
    }

    decltype(TimedCondition::test) plain(const XmlElement& element) {
        std::string what;
        if (const auto value = element.child("ByValueCondition"); value && !value->children().empty()) {
            what = value->children()[0].name();
            if (const auto made = by_value(value->children()[0]))
                return [test = *made](int step, std::vector<RunEntity*>*) { return test(step); };
        } else if (const auto entities = element.child("ByEntityCondition")) {
            const auto inner = entities->child("EntityCondition");
            what = inner && !inner->children().empty() ? inner->children()[0].name() : "ByEntityCondition";
            if (const auto made = entity_condition(*entities)) return *made;
        }
        story.note(element.place() + ": " +
                   (what.empty() ? "an empty condition" : "a " + what + " that cannot be judged") + ": it never holds");
        return [](int, std::vector<RunEntity*>*) { return false; };
    }

    TimedCondition timed(const XmlElement& element) {
        using Edge = TimedCondition::Edge;
        static const std::map<std::string, Edge> kEdges{{"none", Edge::None},
                                                        {"rising", Edge::Rising},
                                                        {"falling", Edge::Falling},
                                                        {"risingOrFalling", Edge::Both}};
        story.ask(1);
        TimedCondition made{plain(element), number_in(element, "delay", scope, 0)};
        if (made.delay < 0) story.note(element.place() + ": a delay below 0 counts as none"), made.delay = 0;
        const std::string name = resolved(element, "conditionEdge", scope).value_or("none");
        const auto edge = kEdges.find(name);
        if (edge == kEdges.end())
            story.note(element.place() + ": conditionEdge '" + name +
                       "' is none of OpenSCENARIO's: it counts as 'none'");
        if (edge != kEdges.end()) made.edge = edge->second;
        return made;
    }
};

}  // namespace

Trigger trigger_of(const std::optional<XmlElement>& trigger, const Parameters& scope, StoryTime& story, bool without) {
    Trigger made{.without = without};
    if (!trigger) return made;
    ConditionReader reader{story, scope};
    for (const XmlElement& group : trigger->children("ConditionGroup")) {
        made.groups.emplace_back();
        for (const XmlElement& each : group.children("Condition")) made.groups.back().push_back(reader.timed(each));
    }
    return made;
}

}  // namespace vesper::roads
