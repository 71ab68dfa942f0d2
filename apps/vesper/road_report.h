// What `vesper road` says of a road. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "photometry/road.h"
#include "road_render.h"

namespace vesper {

/// Layout, figures against the limits of a class (may be null) and figures of each lane, for a terminal.
std::string text_of(const RoadLayout&, const RoadResult&, const LightingClass* wanted);
/// Illuminance and the luminances of every observer as tables: x across, y down, the left edge on top.
std::string grid_text_of(const RoadResult&);
/// One line for each point of the grid. Both with what was rendered, if anything was.
std::string csv_of(const RoadLayout&, const RoadResult&, const RenderedRoad* rendered);
std::string json_of(const RoadLayout&, const RoadResult&, const LightingClass* wanted, const RenderedRoad* rendered);

}  // namespace vesper
