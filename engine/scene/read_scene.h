// Reading scenes from files, whatever their format. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/limits.h"
#include "scene/scene.h"

namespace vesper::scene {

/// Upper bounds on what a file may ask for. A file that states more is refused before anything is allocated for it. The
/// standard ones follow VESPER_LIMITS (base/limits.h).
struct SceneLimits {
    uint64_t file_bytes = scaled_limit(1ull << 30);  ///< of the scene's file and of every file it names, each
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

/// What a file says beyond its scene, for rules that go by the file's own nodes and materials. Lists may be shorter
/// than those of the scene: what they do not have is not marked.
struct SceneSource {
    std::vector<bool> added;            ///< nodes that the reader made beside the file's own: no rule matches them
    std::vector<bool> instances;        ///< of these, the places of a mesh that its parent shows many times
    std::vector<bool> blended;          ///< materials that are opaque while they emit, and else masked
    uint32_t implied_material = kNone;  ///< of what names none: no rule matches it
    std::vector<std::pair<uint32_t, uint32_t>> without_uv;  ///< meshes, and materials in them, for vertices at uv 0
};
inline bool marked(const std::vector<bool>& list, size_t i) { return i < list.size() && list[i]; }
inline void mark(std::vector<bool>& list, size_t i) {
    if (list.size() <= i) list.resize(i + 1);
    list[i] = true;
}

struct LoadedScene {
    Scene scene;
    std::vector<std::string> notes;  ///< what was left out or read with a change, one line each
    bool photometric = false;        ///< whether the file states photometry, as `convert` writes it
    SceneSource source{};
};

/// Reads a scene: glTF 2.0 (docs/gltf.md). Its first bytes choose the format; where they tell none, the name's ending.
/// Throws Error naming the file, the place in it and the reason; of another program's file, the format and the way to
/// glTF.
LoadedScene read_scene(const std::filesystem::path& file, const SceneLimits& limits = {});

/// Whether the name of a file ends as those of scenes do, in capitals or not.
bool is_scene_name(const std::filesystem::path& file);

/// The endings of scenes' names, for messages: ".gltf or .glb" with " or " between the last two, ", " between others.
std::string scene_endings(const char* last_separator = " or ");

}  // namespace vesper::scene
