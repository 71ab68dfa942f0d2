// The parts of a glTF file that hold photometry, made of a scene: for scenes that are saved and for databases that are
// converted. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/scene.h"

namespace vesper::scene {

/// Puts bytes into the file. Returns the index of a buffer view of them.
using AddView = std::function<size_t(std::span<const uint8_t>)>;

/// How a node of the file uses a lamp: the value of an extension. Without a value it does so already.
struct LampUse {
    const char* extension = nullptr;
    nlohmann::json value{};
};

struct LampParts {
    nlohmann::json lights = nlohmann::json::array();    ///< for the list of KHR_lights_punctual
    nlohmann::json profiles = nlohmann::json::array();  ///< for that of EXT_lights_ies
    nlohmann::json lobes = nlohmann::json::array(), openings = nlohmann::json::array();  ///< of the extras block
    std::vector<LampUse> uses;                                                           ///< for each lamp of the scene
};

/// `lights` and `profiles`: how many of either the file has already, the first of the scene's.
LampParts lamp_parts(const Scene&, size_t lights, size_t profiles, const AddView&);

/// emissiveFactor, of which the largest component is 1, and emissiveStrength: their product is in cd/m^2.
struct EmissionParts {
    glm::dvec3 factor{0};
    double strength = 0;
};
EmissionParts emission_parts(glm::dvec3 emission);

/// The extras block (docs/gltf.md), without pictures and provenance. `file_nodes`: for each node its index in the file.
nlohmann::json photometry_block(const Scene&, const LampParts&, std::span<const uint32_t> file_nodes);

}  // namespace vesper::scene
