// Traffic lights that a recorded run switches. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roads/esmini_run.h"
#include "scene/scene.h"

namespace vesper::drive {

/// One lens of a traffic light, and when it shines.
struct SignalLens {
    enum class Mode : uint8_t { Off, On, Flashing };
    struct Change {
        double time = 0;  ///< s
        Mode mode = Mode::Off;
    };
    uint32_t node = scene::kNone;  ///< of the scene: its lamp
    bool otherwise = false;        ///< before the first change
    std::vector<Change> changes;   ///< times ascending

    bool shines(double seconds) const;
};

/// What the lenses of a signal, whose colours from the top these are, show in a state of it (docs/esmini.md has the
/// words): one word for each by its place ("on;off;off"), or words that name what shines ("red", "flashing yellow";
/// "off"). Nothing where it is none of that.
std::optional<std::vector<SignalLens::Mode>> lenses_in(const std::string& state,
                                                       const std::vector<std::string>& colours);

/// Of all lenses ("signal_ID/red" and so on: LitRoadOptions::every_lens) of a scene. Signals that the run does not set
/// stay as they are without one: red for cars, green for people on foot; so they do in states that are not understood,
/// of each of which there is one note.
std::vector<SignalLens> lenses_of(const scene::Scene&, const roads::RoadNetwork&, const roads::EsminiRun&,
                                  std::vector<std::string>& notes);

}  // namespace vesper::drive
