#include "load_scene.h"

#include <unistd.h>

#include <string>

#include "scene/convert.h"

namespace vesper::drive {
namespace {

namespace fs = std::filesystem;

// A folder that is gone with its maker.
struct Scratch {
    fs::path folder = fs::temp_directory_path() / ("vesper-drive-" + std::to_string(::getpid()));
    Scratch() { fs::create_directories(folder); }
    ~Scratch() {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
    }
};

}  // namespace

scene::LoadedScene load_scene(const fs::path& file, const fs::path& photometry) {
    if (photometry.empty()) return scene::read_scene(file);
    const Scratch scratch;
    const fs::path made = scratch.folder / "scene.gltf";
    scene::convert(file, photometry, made);
    return scene::read_scene(made);
}

const std::string& lamp_name(const scene::Scene& scene, uint32_t node) {
    const scene::Lamp& lamp = scene.lamps[scene.nodes[node].lamp];
    return lamp.kind == scene::Lamp::Kind::Measured || lamp.name.empty() ? scene.nodes[node].name : lamp.name;
}

}  // namespace vesper::drive
