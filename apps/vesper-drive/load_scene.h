// Scenes as they are driven in. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "scene/read_scene.h"

namespace vesper::drive {

/// A glTF file, with that photometry if it is not empty (as vesper convert applies it). Throws Error.
scene::LoadedScene load_scene(const std::filesystem::path& file, const std::filesystem::path& photometry);

/// The name that rules and settings know the lamp of a node by.
const std::string& lamp_name(const scene::Scene&, uint32_t node);

}  // namespace vesper::drive
