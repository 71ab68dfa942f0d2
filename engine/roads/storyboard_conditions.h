// Conditions of a storyboard, judged by the recorded run. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include "roads/storyboard_elements.h"

namespace vesper::roads {

class LaneGraph;

/// State that conditions and actions read.
struct StoryTime {
    EsminiRun& run;
    const RoadNetwork* roads;
    ScenarioFile& scenario;
    XmlElement storyboard;
    std::vector<double> times;  ///< of the steps
    StoryElements elements{};
    std::map<std::string, std::string> signals{};  ///< states of traffic lights now
    Parameters parameters{}, variables{};          ///< set by actions; variables as declared, too
    std::map<std::string, std::vector<RunEntity*>, std::less<>> entities{};  ///< by name; of selections those they hold
    std::map<std::string_view, const Road*> road_by_id{};
    std::shared_ptr<LaneGraph> lanes{};  ///< where actions need them
    std::vector<std::string> notes{};
    size_t kept = 0;       ///< changes of the run
    size_t questions = 0;  ///< asked every step: conditions, once more for each entity; actors of actions

    /// Elements that conditions refer to; found when all are read.
    struct Reference {
        ElementKind kind;
        std::string name, place;
        std::shared_ptr<size_t> index;
    };
    std::vector<Reference> references{};

    double at(int step) const { return times[static_cast<size_t>(step)]; }
    /// Roads, entities and selections by name; before anything is read.
    void find_places();
    void find_references();
    /// The entities of a name or a selection in an attribute; a note if there are none.
    std::vector<RunEntity*> all_of(const XmlElement& element, const char* attribute, const Parameters& scope);
    RunEntity* one_of(const XmlElement& element, const char* attribute, const Parameters& scope);
    /// Adds to the evaluations per step. Throws Error beyond the limit.
    void ask(size_t more);
    /// Counts a stored change of a lamp, a traffic light or the time of day. Throws Error beyond the limit.
    void keep();
    void note(const std::string& what);
};

/// Removes repeated entities.
void each_once(std::vector<RunEntity*>& entities);

/// A condition with its delay and edge, evaluated as in esmini.
struct TimedCondition {
    enum class Edge : uint8_t { None, Rising, Falling, Both };
    std::function<bool(int step, std::vector<RunEntity*>* triggering)> test;
    double delay = 0;  ///< s
    Edge edge = Edge::None;
    bool asked = false, before = false;    ///< since the beginning; the answer before
    std::optional<bool> said{};            ///< last, the edge considered
    bool settled = false;                  ///< `delay` ago
    std::vector<int> changes{};            ///< steps at which it changed what it says
    size_t next = 0;                       ///< of these, not `delay` old
    std::vector<RunEntity*> triggering{};  ///< of which it held last

    bool holds(int step, const StoryTime& story, bool select);
};

/// A trigger: holds if all conditions of one of its groups hold.
struct Trigger {
    std::vector<std::vector<TimedCondition>> groups{};
    bool without = true;                   ///< value without groups
    bool select = false;                   ///< the entities that trigger are asked for
    std::vector<RunEntity*> triggering{};  ///< where it held

    /// At ascending steps.
    bool holds(int step, const StoryTime& story);
    /// Resets the trigger for the next execution.
    void forget();
};

/// A missing trigger always holds.
Trigger trigger_of(const std::optional<XmlElement>& trigger, const Parameters& scope, StoryTime& story,
                   bool without = true);

}  // namespace vesper::roads
