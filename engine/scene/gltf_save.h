// Writing a scene as a photometric glTF file. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace vesper::scene {

/// Whether glTF is written under a file of this name: .gltf as text, .glb in binary form.
bool is_gltf_name(const std::filesystem::path& file);

/// Writes the scene to a self-contained file, named .gltf or .glb, that read_scene gives back: lamps and materials in
/// the standard parts and the vesper extras block (docs/gltf.md). The file is replaced only when all of it is
/// written. Scenes with pictures (textures, luminance pictures, an environment) come from glTF files and are converted
/// there: here they are refused. `source` goes into the provenance. Throws Error.
void save_gltf(const Scene& scene, const std::string& source, const std::filesystem::path& file);

}  // namespace vesper::scene
