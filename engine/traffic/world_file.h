// World files (docs/worlds.md). SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/tunnel.h"
#include "traffic/world.h"

namespace vesper::scene {
class JsonValue;
}

namespace vesper::traffic {

/// Roles of vehicle lamps, by the names of their rules in the photometry file.
struct LampRoles {
    std::vector<std::string> low, high, tail, brake, left, right, front_fog, rear_fog, reversing;
};
/// Names of roles in files.
constexpr std::array<std::pair<const char*, std::vector<std::string> LampRoles::*>, 9> kLampRoles{
    {{"low", &LampRoles::low},
     {"high", &LampRoles::high},
     {"tail", &LampRoles::tail},
     {"brake", &LampRoles::brake},
     {"left", &LampRoles::left},
     {"right", &LampRoles::right},
     {"front_fog", &LampRoles::front_fog},
     {"rear_fog", &LampRoles::rear_fog},
     {"reversing", &LampRoles::reversing}}};

/// Reads the object that names them, and the "front" of a model as a turn about +Y to -Z, rad. Throw Error, naming
/// file, place and reason.
LampRoles read_roles(const scene::JsonValue&);
double read_front(const scene::JsonValue&);

struct WorldFile {
    std::filesystem::path scene;       ///< a glTF file
    std::filesystem::path photometry;  ///< applied to it when it is loaded; empty: the scene is photometric
    std::string camera;                ///< of the scene, in the driver's car; empty: 1.2 m above its middle
    WorldDescription world;
    std::map<std::string, double> turns;  ///< rad about +Y from the front of a node's model to -Z; missing: 0
    LampRoles roles;
    std::vector<std::string> by_day;  ///< names of lamps that are lit by day, too; empty: all
    std::vector<scene::Tunnel> tunnels;
};

/// Reads a world file. Throws Error, naming file, place and reason.
WorldFile read_world(const std::filesystem::path&);

}  // namespace vesper::traffic
