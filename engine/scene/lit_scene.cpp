// Scenes with photometry, from their files. SPDX-License-Identifier: MIT
#include <new>
#include <optional>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/named_file.h"
#include "scene/apply_photometry.h"
#include "scene/rotation.h"

namespace vesper::scene {
namespace {

/// A luminance without texture coordinates would be arbitrary.
void check_pictures(const LoadedScene& loaded, const std::string& name) {
    for (const auto& [mesh, material] : loaded.source.without_uv) {
        const Material& shown = loaded.scene.materials[material];
        if (shown.emission_picture.image != kNone)
            throw Error(name + ": mesh '" + one_line(loaded.scene.meshes[mesh].name) +
                        "': has no texture coordinates, by which the luminance picture '" +
                        loaded.scene.luminance_pictures[shown.emission_picture.image].name + "' of material '" +
                        one_line(shown.name) + "' would lie");
    }
}

LoadedScene read_lit(const std::filesystem::path& file, const Photometry& photometry, PhotometryReport* report,
                     const SceneLimits& limits) {
    const std::string name = one_line(file.string());
    LoadedScene loaded = read_scene(file, limits);
    if (loaded.photometric)
        throw Error(name + ": /extras/vesper: the file has been converted already: convert the original");
    PhotometryReport made = apply_photometry(loaded.scene, photometry, name, loaded.source);
    check_transforms(loaded.scene, name);
    check_pictures(loaded, name);
    loaded.source = {};
    loaded.photometric = true;
    if (report) *report = std::move(made);
    return loaded;
}

}  // namespace

Photometry read_photometry_for(const std::filesystem::path& scene, const std::filesystem::path& photometry) {
    const io::AllowedFolder beside_scene(scene.has_parent_path() ? scene.parent_path() : ".");
    return read_photometry(photometry);
}

LoadedScene read_lit_scene(const std::filesystem::path& file, const std::filesystem::path& photometry,
                           PhotometryReport* report, const SceneLimits& limits) {
    if (photometry.empty()) return read_scene(file, limits);
    const Budget budget("reading " + one_line(file.string()));
    try {
        return read_lit(file, read_photometry_for(file, photometry), report, limits);
    } catch (const std::bad_alloc&) {
        throw OutOfHostMemory(one_line(file.string()) + ": not enough memory");
    }
}

}  // namespace vesper::scene
