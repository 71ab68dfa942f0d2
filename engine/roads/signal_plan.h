// Which traffic lights are green when. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include <vesper/roads.hpp>

#include "roads/lanes.h"

namespace vesper::roads {

enum class SignalAspect : uint8_t { Off, Red, Amber, Green };

/// The part of a cycle in which a traffic light is green, then amber; it is red otherwise.
struct SignalPhase {
    double cycle = 1;                       ///< s
    double from = 0, green = 0, amber = 0;  ///< s: begin in the cycle, and durations
};
SignalAspect aspect_at(const SignalPhase&, double time);

/// A plan for all traffic lights of a network. Lights of one controller, and lights of one road that face the same way,
/// are alike; heads behind a junction, whose ways the file does not say, go with the road that faces nearest to theirs.
/// In a junction two of them are green together only if no way of one comes within 2.5 m of a way of the other, or both
/// begin on one road. People on foot have green alone. A light without another one to yield to waits for a stage of the
/// same length.
class SignalPlan {
public:
    SignalPlan(const RoadNetwork&, const LaneGraph&);

    /// `signal`: index into the signals of a road. Signals that are no traffic lights have no phase.
    SignalPhase of(uint32_t road, uint32_t signal) const;

private:
    std::map<std::pair<uint32_t, uint32_t>, SignalPhase> phases_;
};

/// Throws Error unless a time is within 0 to 1e6 s.
void check_signal_time(double time);

/// The aspect that an option asks for.
SignalAspect aspect_of(SignalState, const SignalPhase&, double time, bool on_foot);

}  // namespace vesper::roads
