#include "scene/read_scene.h"

#include <algorithm>
#include <span>
#include <string_view>

#include "base/error.h"
#include "base/lower.h"
#include "base/one_line.h"
#include "io/image_file.h"
#include "io/read_file.h"
#include "scene/gltf.h"
#include "scene/other_formats.h"

namespace vesper::scene {
namespace {

/// A format of scenes.
struct SceneReader {
    std::span<const std::string_view> endings;       ///< of names, in small letters
    bool (*begins)(std::span<const uint8_t> start);  ///< whether a file that begins like this is one
    LoadedScene (*read)(const std::filesystem::path&, const SceneLimits&);
};

constexpr std::string_view kGltfEndings[]{".gltf", ".glb"};

// The one list of formats: a new reader is a line here.
constexpr SceneReader kReaders[]{
    {kGltfEndings, begins_like_gltf, read_gltf},
};

bool has_ending(const SceneReader& reader, const std::filesystem::path& file) {
    const std::string ending = lower(file.extension().string());
    return std::ranges::find(reader.endings, ending) != reader.endings.end();
}

}  // namespace

LoadedScene read_scene(const std::filesystem::path& file, const SceneLimits& limits) {
    const std::vector<uint8_t> start = io::read_start(file, kOtherStart);
    for (const SceneReader& reader : kReaders)
        if (reader.begins(start)) return reader.read(file, limits);
    std::error_code failed;
    const uintmax_t size = std::filesystem::file_size(file, failed);
    const std::string other = other_format(start, failed ? 0 : size, lower(file.extension().string()));
    if (!other.empty()) throw Error(one_line(file.string()) + ": " + other);
    if (const std::string picture = io::media_type(start); !picture.empty())
        throw Error(one_line(file.string()) + ": is no scene but a picture of type " + picture);
    for (const SceneReader& reader : kReaders)
        if (has_ending(reader, file)) return reader.read(file, limits);
    throw Error(one_line(file.string()) + ": is no scene: " + scene_endings() + " is expected");
}

bool is_scene_name(const std::filesystem::path& file) {
    return std::ranges::any_of(kReaders, [&](const SceneReader& reader) { return has_ending(reader, file); });
}

std::string scene_endings(const char* last_separator) {
    std::vector<std::string_view> endings;
    for (const SceneReader& reader : kReaders)
        endings.insert(endings.end(), reader.endings.begin(), reader.endings.end());
    std::string text;
    for (size_t i = 0; i < endings.size(); ++i)
        text += (i == 0 ? "" : i + 1 < endings.size() ? ", " : last_separator) + std::string(endings[i]);
    return text;
}

}  // namespace vesper::scene
