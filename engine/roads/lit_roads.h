// A road network as a scene to drive through at night. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roads/lanes.h"
#include "scene/scene.h"

namespace vesper::roads {

/// Street lamps along roads that the file has none for.
struct StreetLampOptions {
    enum class Side : uint8_t { Auto, Right, Left, Both, Alternating };
    double spacing = 30;                    ///< m along the road; 0: no lamps
    double height = 0;                      ///< m of the light point; 0: 8 m, on wide roads up to 12 m
    Side side = Side::Auto;                 ///< Auto: the outer side of traffic; both where the road is wider than 12 m
    double overhang = 1.2;                  ///< m, from the pole towards the road
    double colour_temperature = 3000;       ///< K
    std::optional<Distribution> luminaire;  ///< instead of that of data/photometry/street-lamp.ies
    bool beside_own = true;                 ///< rows of them also where the file has street lamps among its objects
};

struct LitRoadOptions {
    std::optional<StreetLampOptions> lamps;  ///< nothing: as above, unless the file has street lamps among its objects
    double chord = 0.01;  ///< m, how far surfaces may lie from the roads of the file (reference line and borders)
    double margin = 120;  ///< m of ground around the roads, before it goes on flat to the horizon
    double ambient = 0.1;     ///< lx on every surface, and
    double sky = 0.02;        ///< cd/m^2: a clear night over a town, as vesper convert has it
    bool headlamps = true;    ///< the driver's car has low beams
    bool every_lens = false;  ///< of a traffic light is a lamp, for who switches them; otherwise only the one that is lit
    double eye_height = 1.2;  ///< m, of the driver
};

struct LitRoads {
    Scene scene;
    std::vector<std::string> notes;  ///< what was built, one line each
};

/// Lane surfaces (R3), kerbs, pavements and verges, markings and signs that reflect back, objects, traffic lights,
/// street lamps and the ground around them. Cameras: "driver", who follows the longest way over the lanes in the
/// animation, at the speed limit or what bends allow; "overview"; "roadside". Nodes "car_ego", "street_lamp_*/light",
/// "signal_*/red", ".../yellow", ".../green" Throws Error where it would be too large.
LitRoads lit_roads(const RoadNetwork& network, const LitRoadOptions& options = {});

}  // namespace vesper::roads
