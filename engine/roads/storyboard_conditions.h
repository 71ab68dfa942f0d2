// Conditions of a storyboard, judged by the recorded run. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include "roads/esmini_parts.h"

namespace vesper {

/// How far an element of the storyboard is. Steps are those of the run; -1: not yet.
struct ElementState {
    int started = -1, ended = -1;
    int running = 0;  ///< how many times it is under way
};

/// What conditions look at.
struct StoryTime {
    const EsminiRun& run;
    const RoadNetwork* roads;
    std::vector<double> times;                       ///< of the steps
    std::map<std::string, ElementState> elements{};  ///< "event/NAME", "action/NAME", "maneuver/NAME", ...
    std::map<std::string, std::string> signals{};    ///< states of traffic lights now
    std::vector<std::string> notes{};
    size_t questions = 0;                            ///< that conditions ask every step, one for each triggering entity

    const RunEntity* find(const std::string& name) const;
    void note(const std::string& what);
};

/// Whether something is so at a step.
using Condition = std::function<bool(int step)>;

/// A trigger: any of its groups, of which all conditions hold, with their delays and edges. Always true where there is
/// none. Asked once for every step, in order.
Condition trigger_of(const std::optional<XmlElement>& trigger, const Parameters& scope, StoryTime& time);

}  // namespace vesper
