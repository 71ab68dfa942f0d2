// Traffic lights that a recorded run switches. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roads/esmini_run.h"
#include "scene/scene.h"

namespace vesper {

/// One lens of a traffic light, and when it shines.
struct SignalLens {
    enum class Mode : uint8_t { Off, On, Flashing };
    struct Change {
        double time = 0;  ///< s
        Mode mode = Mode::Off;
    };
    uint32_t node = kNone;        ///< of the scene: its lamp
    bool otherwise = false;       ///< before the first change
    std::vector<Change> changes;  ///< times ascending

    bool shines(double seconds) const;
};

/// How a lens is in a state of its signal: "on;off;off" by its place from the top (on, off, flashing: once a second), or words that
/// name what shines ("red", "yellow" or "amber", "green"; "off"). Nothing where the state is none of that.
std::optional<SignalLens::Mode> lens_in(const std::string& state, size_t place, const std::string& colour);

/// Of all lenses ("signal_ID/red" and so on: LitRoadOptions::every_lens) of a scene. Signals that the run does not set stay as they
/// are without one: red for cars, green for people on foot. Adds a note on what was not understood.
std::vector<SignalLens> lenses_of(const Scene&, const RoadNetwork&, const EsminiRun&, std::vector<std::string>& notes);

}  // namespace vesper
