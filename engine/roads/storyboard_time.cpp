// Entities and elements that a storyboard names, and its conditions over time. SPDX-License-Identifier: MIT
#include <algorithm>

#include "roads/storyboard_conditions.h"

namespace vesper::roads {
namespace {

constexpr size_t kMaxChanges = 2'000'000;
constexpr double kMaxWork = 5e8;  // elements and questions, times steps
constexpr size_t kMaxQuestions = 10'000'000, kMaxMembers = 1'000'000;
constexpr size_t kMaxStoryNotes = 50;

/// What ByType of a selection calls it.
std::string_view type_of(RunEntity::Kind kind) {
    using Kind = RunEntity::Kind;
    if (kind == Kind::Object) return "miscellaneous";
    return kind == Kind::Pedestrian || kind == Kind::Animal ? "pedestrian" : "vehicle";
}

}  // namespace

void StoryTime::find_places() {
    if (roads)
        for (const Road& road : roads->roads) road_by_id.try_emplace(road.id, &road);
    std::map<std::string, std::vector<RunEntity*>, std::less<>> by_type;
    for (RunEntity& entity : run.entities) {
        entities[entity.name].push_back(&entity);
        by_type[std::string(type_of(entity.kind))].push_back(&entity);
    }
    const Parameters& scope = scenario.parameters();
    size_t members = 0;
    for (const XmlElement& each : scenario.root().children_of("Entities", "EntitySelection")) {
        std::vector<RunEntity*> selected;
        const auto take = [&](const std::vector<RunEntity*>& more) {
            if ((members += more.size()) > kMaxMembers)
                each.fail("selections have more than " + std::to_string(kMaxMembers) + " members");
            selected.insert(selected.end(), more.begin(), more.end());
        };
        for (const XmlElement& held : each.children("Members")) {
            for (const XmlElement& member : held.children("EntityRef")) take(all_of(member, "entityRef", scope));
            for (const XmlElement& member : held.children("ByType")) {
                const auto found = by_type.find(resolved(member, "objectType", scope).value_or(""));
                if (found != by_type.end()) take(found->second);
            }
        }
        each_once(selected);
        entities.try_emplace(resolved(each, "name", scope).value_or(""), std::move(selected));
    }
}

std::vector<RunEntity*> StoryTime::all_of(const XmlElement& element, const char* attribute, const Parameters& scope) {
    const std::string name = resolved(element, attribute, scope).value_or("");
    const auto found = entities.find(name);
    if (found == entities.end()) {
        note(element.place() + ": '" + name + "' is no entity of the run");
        return {};
    }
    return found->second;
}

RunEntity* StoryTime::one_of(const XmlElement& element, const char* attribute, const Parameters& scope) {
    const auto found = all_of(element, attribute, scope);
    return found.empty() ? nullptr : found.front();
}

void StoryTime::find_references() {
    for (const Reference& each : references) {
        const auto [first, count] = elements.find(each.kind, each.name);
        *each.index = first;
        if (count == 0) note(each.place + ": there is no element '" + each.name + "': it never holds");
        if (count > 1)
            note(each.place + ": " + std::to_string(count) + " elements are called '" + each.name +
                 "': the first counts");
    }
}

void StoryTime::ask(size_t more) {
    questions += more;
    const double asked = static_cast<double>(elements.size() + questions) * static_cast<double>(times.size());
    if (asked > kMaxWork || questions > kMaxQuestions)
        storyboard.fail("too many elements and conditions for so long a run");
}

void StoryTime::keep() {
    if (++kept > kMaxChanges)
        storyboard.fail("changes lamps and signals more than " + std::to_string(kMaxChanges) + " times");
}

void StoryTime::note(const std::string& what) {
    if (notes.size() < kMaxStoryNotes && std::find(notes.begin(), notes.end(), what) == notes.end())
        notes.push_back(what);
}

void each_once(std::vector<RunEntity*>& entities) {
    std::sort(entities.begin(), entities.end());
    entities.erase(std::unique(entities.begin(), entities.end()), entities.end());
}

bool TimedCondition::holds(int step, const StoryTime& story, bool select) {
    triggering.clear();
    const bool now = test(step, select ? &triggering : nullptr);
    // The first answer since the beginning is no edge.
    const bool rises = asked && now && !before, falls = asked && !now && before;
    const bool says = edge == Edge::None ? now : (edge != Edge::Falling && rises) || (edge != Edge::Rising && falls);
    asked = true, before = now;
    if (said != says) changes.push_back(step), said = says;
    // Whatever it said at a time that has become old enough since it was asked last.
    bool held = false, any = false;
    for (; next < changes.size() && story.at(changes[next]) <= story.at(step) - delay + 1e-6; ++next) {
        settled = (changes.size() - next) % 2 == 1 ? *said : !*said;
        held = held || settled, any = true;
    }
    if (next == changes.size()) changes.clear(), next = 0;
    return any ? held : settled;
}

bool Trigger::holds(int step, const StoryTime& story) {
    bool any = groups.empty() && without;
    triggering.clear();
    for (std::vector<TimedCondition>& group : groups) {
        bool all = !group.empty();
        // As esmini: after one that does not hold, only those with a delay are asked.
        for (TimedCondition& each : group)
            if (all || each.delay > 0) all = each.holds(step, story, select) && all;
        any = any || all;
        for (const TimedCondition& each : group)
            if (all) triggering.insert(triggering.end(), each.triggering.begin(), each.triggering.end());
    }
    if (any)
        for (std::vector<TimedCondition>& group : groups)
            for (TimedCondition& each : group) each.asked = false;
    each_once(triggering);
    return any;
}

void Trigger::forget() {
    for (std::vector<TimedCondition>& group : groups)
        for (TimedCondition& each : group)
            each.changes.clear(), each.next = 0, each.said.reset(), each.settled = false, each.asked = false;
}

}  // namespace vesper::roads
