// Roads of others to drive on: an OpenDRIVE file, and a run that esmini recorded on it. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "signal_lens.h"
#include "traffic/world_file.h"

namespace vesper::drive {

struct RoadWorld {
    scene::Scene scene;
    traffic::WorldFile world;
    std::vector<SignalLens> lenses;
    std::vector<std::string> notes;
};

/// The lit road (roads/lit_roads.h) with its lanes to drive on and its kerbs. On it the entities of the run, as boxes
/// with lamps, and traffic lights as its scenario sets them; where more than half of it lies off the roads, it is
/// refused. Without a run some traffic. Throws Error naming file, place and reason.
RoadWorld road_world(const std::filesystem::path& roads, const std::filesystem::path& run,
                     const std::filesystem::path& scenario);

}  // namespace vesper::drive
