// glTF 2.0 as a format of scenes (.gltf, .glb). Not a public header: read_scene() is. SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "scene/read_scene.h"

namespace vesper::scene {

/// Reads a scene: meshes, materials, node tree, cameras, KHR_lights_punctual (cd), EXT_lights_ies,
/// KHR_materials_emissive_strength (cd/m^2), animations of nodes, and the vesper extras block (docs/gltf.md)
/// where there is one. Throws Error naming the file, the place in it (JSON pointer or byte) and the reason.
LoadedScene read_gltf(const std::filesystem::path& file, const SceneLimits& limits = {});

/// Whether a file begins as glTF does: with the mark of .glb, or with an object.
bool begins_like_gltf(std::span<const uint8_t> start);

}  // namespace vesper::scene
