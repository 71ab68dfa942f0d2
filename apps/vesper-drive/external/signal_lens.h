// Lenses of traffic lights that another program switches. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "osi/timeline.h"
#include "roads/signal_plan.h"
#include "scene/scene.h"

namespace vesper::drive {

/// A lamp of the scene that is a lens of a traffic light.
struct SignalLens {
    uint32_t node = scene::kNone;
    std::string signal;  ///< id of its signal in the roads; empty: not known
    osi::TrafficLight::Colour colour = osi::TrafficLight::Colour::Other;
    glm::dvec3 position{0};  ///< in the world, m
    bool otherwise = false;  ///< whether it shines while messages speak of other signals alone, or without a plan
    std::optional<roads::SignalPhase> phase{};  ///< of the plan of the roads

    /// Whether it shines at a time of the drive, s, if no message says it of any signal.
    bool shines(double seconds) const;
};

/// Lenses of roads ("signal_ID/red" and so on: LitRoadOptions::every_lens), and other lamps that do not move and have
/// the word red, yellow, amber or green in their name. Without a plan, cars wait: red for them, green for people on
/// foot. `phases`: LitRoads::phases.
std::vector<SignalLens> lenses_of(const scene::Scene&, const std::map<std::string, roads::SignalPhase>& phases = {});

/// Finds the lens that a traffic light of a message is: that of its signal and colour, or the nearest of its colour
/// within 1.5 m.
class LensFinder {
public:
    /// kNone: there is none. `position`: of the light, in the world.
    uint32_t find(const std::vector<SignalLens>&, const osi::TrafficLight&, const glm::dvec3& position);

private:
    std::map<std::pair<uint64_t, osi::TrafficLight::Colour>, uint32_t> known_;  // by the light's id and colour
};

constexpr double kSignalPeriod = 1;  ///< s, of lenses that flash

}  // namespace vesper::drive
