// Writing a scene as a photometric glTF file. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace vesper {

/// The scene as a self-contained file that read_gltf gives back: lamps and materials in the standard parts and the
/// vesper extras block (docs/photometry.md). Scenes with pictures (textures, luminance pictures, an environment) come
/// from glTF files and are converted there: here they are refused. `source` goes into the provenance. Throws Error.
std::vector<uint8_t> encode_scene(const Scene& scene, const std::string& source, bool binary);

/// The same to a file named .gltf or .glb, which is replaced only when the whole of it is written.
void save_gltf(const Scene& scene, const std::string& source, const std::filesystem::path& file);

}  // namespace vesper
