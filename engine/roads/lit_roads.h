// A road network as a scene to drive through at night. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roads/lanes.h"
#include "scene/scene.h"

namespace vesper::roads {

/// Street lamps along roads, in addition to those of the file.
struct StreetLampOptions {
    enum class Side : uint8_t { Auto, Right, Left, Both, Alternating };
    double spacing = 30;                    ///< m along the road; 0: no lamps
    double height = 0;                      ///< m of the light point; 0: 8 m, on wide roads up to 12 m
    Side side = Side::Auto;                 ///< Auto: the outer side of traffic; both where the road is wider than 12 m
    double overhang = 1.2;                  ///< m, from the pole towards the road
    double colour_temperature = 3000;       ///< K
    std::optional<Distribution> luminaire;  ///< default: data/photometry/street-lamp.ies
    bool beside_own = true;                 ///< add rows even if the file has street lamps
};

struct LitRoadOptions {
    std::optional<StreetLampOptions> lamps;  ///< empty: the defaults, unless the file has street lamps
    double chord = 0.01;      ///< m, largest distance of surfaces from the file's reference lines and borders
    double margin = 120;      ///< m of ground around the roads; beyond it is flat up to the horizon
    double ambient = 0.1;     ///< lx on every surface
    double sky = 0.02;        ///< cd/m^2, as the default of vesper convert
    bool headlamps = true;    ///< the driver's car has low beams
    bool every_lens = false;  ///< true: every lens of a traffic light is a lamp, to be switched; false: only the lit
                              ///< one
    double eye_height = 1.2;  ///< m, of the driver
};

struct LitRoads {
    Scene scene;
    std::vector<std::string> notes;  ///< parts of the scene, one line each
};

/// Lane surfaces (R3), kerbs, pavements and verges, markings and signs that reflect back, objects, traffic lights,
/// street lamps and the ground around them. Cameras: "driver", on the longest way over the lanes in the animation, at
/// the speed limit or that of bends; "overview"; "roadside". Nodes "car_ego", "street_lamp_*/light", "signal_*/red",
/// ".../yellow", ".../green". Throws Error if the scene were too large.
LitRoads lit_roads(const RoadNetwork& network, const LitRoadOptions& options = {});

}  // namespace vesper::roads
