// Roads of others to drive on: an OpenDRIVE file, and what another program moves on it. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "external/external_bodies.h"
#include "external/signal_lens.h"
#include "scene/scene.h"
#include "traffic/world_file.h"

namespace vesper::drive {

struct RoadWorld {
    scene::Scene scene;
    traffic::WorldFile world;
    ExternalBodies bodies;  ///< for the objects of messages
    std::vector<SignalLens> lenses;
    glm::dvec3 origin{0};            ///< of the world, in the frame of the roads
    std::vector<glm::dvec3> things;  ///< where the roads have objects and signals, on the surface, in the world
    std::vector<std::string> notes;
};

/// The lit road (roads/lit_roads.h) with its lanes to drive on and its kerbs. On it bodies for the objects of messages
/// (ExternalBodies); where more than half of their places lie off the roads, they are refused. Without a source some
/// traffic. Throws Error naming file, place and reason.
RoadWorld road_world(const std::filesystem::path& roads, const MessageSource&, std::span<const osi::Message>);

}  // namespace vesper::drive
