// Scenes as they are driven in. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "scene/gltf.h"

namespace vesper::drive {

/// A glTF file, with that photometry if it is not empty (as vesper convert applies it). Throws Error.
scene::LoadedScene load_scene(const std::filesystem::path& file, const std::filesystem::path& photometry);

}  // namespace vesper::drive
