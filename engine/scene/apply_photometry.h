// A photometry file applied to a scene in memory. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "scene/photometry.h"
#include "scene/read_scene.h"

namespace vesper::scene {

/// Result of the rules of a photometry file.
struct PhotometryReport {
    std::vector<std::string> changes;   ///< what was changed, one line each
    std::vector<std::string> warnings;  ///< rules that matched nothing, implausible values, what was left out
    std::vector<uint32_t> node_of;      ///< for each node before, its index now; kNone where it is gone
    std::vector<uint32_t> pictures;  ///< for each of the scene's luminance pictures its index in Photometry::pictures
};

/// Applies a photometry file (docs/photometry.md) to a scene that is not photometric yet: lights go unless the file
/// keeps them; lamps come, on their nodes or on new ones; materials emit and reflect as rules state; ambient light and
/// sky that are not stated are those of a clear night over a city. Distributions and skies have the numbers that a
/// converted file holds, so that both ways give the same scene to the bit. `name` of the scene for messages; `source`
/// of a scene from a file, as it was read. Throws Error naming the rule, or the node, and the reason; the scene is then
/// of no use.
PhotometryReport apply_photometry(Scene& scene, const Photometry& photometry, const std::string& name,
                                  const SceneSource& source = {});

/// A scene from a file, with a photometry file applied to it unless that name is empty. The photometry file may name
/// what lies in the folder of the scene; the scene may not name what lies beside the photometry. `report` may be null.
/// Throws Error.
LoadedScene read_lit_scene(const std::filesystem::path& file, const std::filesystem::path& photometry,
                           PhotometryReport* report = nullptr, const SceneLimits& limits = {});

/// The photometry file for that scene, see above.
Photometry read_photometry_for(const std::filesystem::path& scene, const std::filesystem::path& photometry);

}  // namespace vesper::scene
