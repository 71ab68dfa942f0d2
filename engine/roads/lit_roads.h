// A road network as a scene to drive through at night. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <vesper/roads.hpp>

#include "photometry/distribution.h"
#include "roads/lanes.h"
#include "roads/signal_plan.h"
#include "scene/scene.h"

namespace vesper::roads {

struct LitRoadOptions {
    StreetLampOptions lamps;  ///< rows of them
    std::optional<photometry::Distribution>
        luminaire;            ///< of all street lamps; default: data/photometry/street-lamp.ies
    double chord = 0.01;      ///< m, largest distance of surfaces from the file's reference lines and borders
    double margin = 120;      ///< m of ground around the roads; beyond it is flat up to the horizon
    double ambient = 0.1;     ///< lx on every surface
    double sky = 0.02;        ///< cd/m^2, as the default of vesper convert
    bool headlamps = true;    ///< the driver's car has low beams
    bool every_lens = false;  ///< true: every lens of a traffic light is a lamp, to be switched; false: only the lit
                              ///< one
    SignalState signals = SignalState::Plan;  ///< the lit lens of traffic lights
    double signal_time = 0;                   ///< s of the plan
    double eye_height = 1.2;                  ///< m, of the driver
};

/// Throws Error if a value is out of range.
void check_street_lamps(const StreetLampOptions&);

struct LitRoads {
    scene::Scene scene;
    std::vector<std::string> notes;             ///< parts of the scene, one line each
    std::map<std::string, SignalPhase> phases;  ///< of traffic lights, by the names of their lenses before the slash
};

/// Lane surfaces (R3), kerbs, pavements and verges, markings and signs that reflect back, objects, traffic lights,
/// street lamps and the ground around them. Cameras: "driver", on the longest way over the lanes in the animation, at
/// the speed limit or that of bends; "overview"; "roadside". Nodes "car_ego", "street_lamp_*/light", "signal_*/red",
/// ".../yellow", ".../green". Throws Error if the scene were too large.
LitRoads lit_roads(const RoadNetwork& network, const LitRoadOptions& options = {});

}  // namespace vesper::roads
