#include "scenes.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "arguments/arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "gpu_scene/cameras.h"
#include "own_data.h"
#include "scene/convert.h"
#include "street.h"

namespace vesper::bench {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kStreetLamps = 256, kTownLamps = 4096;

}  // namespace

Scenes::Scenes() {
    std::error_code failed;
    std::string pattern = (fs::temp_directory_path(failed) / "vesper-bench-XXXXXX").string();
    if (failed || !mkdtemp(pattern.data())) throw Error("no temporary folder: " + one_line(pattern));
    folder_ = pattern;
}

Scenes::~Scenes() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

std::string Scenes::folder(const std::string& name) const {
    fs::create_directories(folder_ + "/" + name);
    return folder_ + "/" + name;
}

void Scenes::prepare(const std::string& name) {
    if (is_generated(name) || files_.contains(name)) return;
    if (name == "rivoli" || name == "rivoli-measured") {
        const fs::path data = apps::own_data() / "rivoli";
        files_[name] = folder_ + "/" + name + ".glb";
        scene::convert(data / "rivoli.gltf",
                       data / (name == "rivoli" ? "rivoli.photometry.json" : "rivoli.measured.photometry.json"),
                       files_[name]);
    } else if (scene::is_scene_name(name)) {
        files_[name] = name;
    } else {
        throw Error("--scene " + one_line(name) + ": rivoli, rivoli-measured, street, town or a " +
                    scene::scene_endings() + " file is expected");
    }
}

scene::Scene Scenes::load(const std::string& name, uint32_t lamps, uint64_t triangles, const std::string& luminaire,
                          const std::string& camera) const {
    if (name == "town") return lamp_town(lamps != kOwnLamps ? lamps : kTownLamps, triangles, luminaire);
    if (name == "street") return lamp_street(lamps != kOwnLamps ? lamps : kStreetLamps, triangles, luminaire);
    scene::Scene scene = scene::read_scene(files_.at(name)).scene;
    const gpu_scene::View view = gpu_scene::camera_view(scene, {scene::world_transforms(scene, 0)}, camera, {1, 1});
    if (lamps != kOwnLamps) keep_nearest_lamps(scene, glm::vec3(gpu_scene::eye_of(view)), lamps);
    return scene;
}

bool is_generated(const std::string& name) { return name == "street" || name == "town"; }

void keep_nearest_lamps(scene::Scene& scene, glm::vec3 eye, uint32_t count) {
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    std::vector<uint32_t> lamps;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].lamp != scene::kNone) lamps.push_back(i);
    if (lamps.size() < count)
        throw Error("--lamps " + std::to_string(count) + ": the scene has " + std::to_string(lamps.size()));
    std::stable_sort(lamps.begin(), lamps.end(), [&](uint32_t a, uint32_t b) {
        return glm::distance(glm::vec3(world[a][3]), eye) < glm::distance(glm::vec3(world[b][3]), eye);
    });
    for (const uint32_t node : std::span(lamps).subspan(count)) scene.nodes[node].lamp = scene::kNone;
}

}  // namespace vesper::bench
