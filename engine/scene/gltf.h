// Reading scenes from glTF 2.0 files (.gltf, .glb). SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/limits.h"
#include "scene/scene.h"

namespace vesper::scene {

/// Upper bounds on what a file may ask for. A file that states more is refused before anything is allocated for it. The
/// standard ones follow VESPER_LIMITS (base/limits.h).
struct SceneLimits {
    uint64_t file_bytes = scaled_limit(1ull << 30);  ///< of the glTF file and of every file it names, each
    uint64_t vertices = scaled_limit(
        50'000'000);  ///< of all meshes together; a fiftieth of it for elements of accessors without a buffer view
    uint64_t indices =
        scaled_limit(150'000'000);  ///< as well; ten times as many corners of triangles for all nodes that show them
    uint64_t texels = scaled_limit(512ull << 20);  ///< of all images together
    uint32_t image_side = 16384;                   ///< px
    uint32_t nodes = static_cast<uint32_t>(scaled_limit(1'000'000));
    uint32_t lamps = kMaxLamps;
    uint64_t candela = scaled_limit(16'000'000);  ///< intensities of all measured distributions together
};

struct LoadedScene {
    Scene scene;
    std::vector<std::string> notes;  ///< what was left out or read with a change, one line each
    bool photometric = false;        ///< whether the file has the vesper extras block, as `convert` writes it
};

/// Reads a scene: meshes, materials, node tree, cameras, KHR_lights_punctual (cd), EXT_lights_ies,
/// KHR_materials_emissive_strength (cd/m^2), animations of nodes, and the vesper extras block (docs/gltf.md)
/// where there is one. Throws Error naming the file, the place in it (JSON pointer or byte) and the reason.
LoadedScene read_gltf(const std::filesystem::path& file, const SceneLimits& limits = {});

}  // namespace vesper::scene
