// What `vesper road` says of a road. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "road_render.h"
#include "road_targets.h"
#include "roads/road_lighting.h"

namespace vesper::commands {

/// Layout, figures against the limits of a class (may be null) and figures of each lane, for a terminal. `standard`: if
/// occluders count, the figures without them.
std::string text_of(const roads::LoadedLayout&, const roads::RoadLighting&, const roads::LightingClass* wanted,
                    const roads::RoadLighting* standard);
/// Illuminance and the luminances of every observer as tables: x across, y down, the left edge on top.
std::string grid_text_of(const roads::RoadLighting&);
/// One line for each point of the grid. The following with what was rendered and with small targets, if there are any.
std::string csv_of(const roads::LoadedLayout&, const roads::RoadLighting&, const RenderedRoad* rendered,
                   const RoadTargets* targets);
std::string json_of(const roads::LoadedLayout&, const roads::RoadLighting&, const roads::LightingClass* wanted,
                    const roads::RoadLighting* standard, const RenderedRoad* rendered, const RoadTargets* targets);

}  // namespace vesper::commands
