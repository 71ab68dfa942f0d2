// Actions of a storyboard: what they set, and how long they take in the recorded run. Not a public header.
// SPDX-License-Identifier: MIT
#pragma once

#include "roads/storyboard_conditions.h"

namespace vesper::roads {

/// Whether something begun is done at a step; none where it is done at once.
using Progress = std::function<bool(int step)>;

/// One action as read.
struct StoryAction {
    std::function<void(int step)> once{};                        ///< what it does for the run
    std::function<Progress(RunEntity& actor, int step)> each{};  ///< what it does for an actor
    uint32_t domains = 0;  ///< an action of an actor ends those of it that run and have one of these bits: lamps and
    size_t cost = 1;       ///< questions that its beginning is worth, for each actor
    static constexpr uint32_t kLongitudinal = 1u << 30, kLateral = 1u << 31;  ///< motions
};

/// Those of an Action, or of a part of Init. What is not understood is noted and left out.
std::vector<StoryAction> actions_of(const XmlElement& holder, const Parameters& scope, StoryTime& story);

/// Of an action on the motion (LongitudinalAction, LateralAction, SynchronizeAction, FollowTrajectoryAction): only how
/// long it takes.
StoryAction motion_of(const XmlElement& action, const Parameters& scope, StoryTime& story);

}  // namespace vesper::roads
