// Actions of a storyboard: their effects, and their duration in the recorded run. Not a public header.
// SPDX-License-Identifier: MIT
#pragma once

#include "roads/storyboard_conditions.h"

namespace vesper::roads {

/// True if an action that has begun is done at a step; empty if it is done at once.
using Progress = std::function<bool(int step)>;

/// An action.
struct StoryAction {
    std::function<void(int step)> once{};                        ///< effect on the run
    std::function<Progress(RunEntity& actor, int step)> each{};  ///< effect on an actor
    uint32_t domains = 0;  ///< an action of an actor ends those of it that run and have one of these bits: lamps and
    size_t cost = 1;       ///< questions that its beginning is worth, for each actor
    static constexpr uint32_t kLongitudinal = 1u << 30, kLateral = 1u << 31;  ///< motions
};

/// Actions of an Action element, or of a part of Init. Others are left out, with a note.
std::vector<StoryAction> actions_of(const XmlElement& holder, const Parameters& scope, StoryTime& story);

/// An action of motion (LongitudinalAction, LateralAction, SynchronizeAction, FollowTrajectoryAction), with its
/// duration only.
StoryAction motion_of(const XmlElement& action, const Parameters& scope, StoryTime& story);

}  // namespace vesper::roads
