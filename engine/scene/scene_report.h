// What a scene holds, and what in it cannot be right. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace vesper::scene {

/// Which meshes never hide a lamp: those of scene/fixtures.h, none, those at and below a named node.
enum class FixtureRule : uint8_t { Own, None, Named };

/// Lamps that shine alike, whose fixtures follow the same rule and whose names differ by a number at most.
struct LampReport {
    std::string name;
    Lamp::Kind kind = Lamp::Kind::Point;
    size_t number = 0;    ///< of nodes that hold it
    double candela = 0;   ///< greatest; Directional: lx
    double lumens = 0;    ///< of one; Directional: 0
    glm::vec3 colour{1};  ///< linear, luminance 1
    /// Above the lowest surface under each, m; nothing where there is none under any of them.
    std::optional<double> lowest, highest;
    FixtureRule fixture = FixtureRule::Own;
    size_t least_meshes = 0, most_meshes = 0;   ///< nodes with meshes in the fixture of one; Directional: 0
    size_t over_nothing = 0, under_ground = 0;  ///< lamps with no surface below; of these, such with one above
};

struct MaterialReport {
    std::string name;
    double reflectance = 0;              ///< mean of base colour, times vertex colours
    double roughness = 1, metallic = 0;  ///< factors; a texture multiplies them
    bool textured = false;
    double emission = 0;       ///< greatest luminance, cd/m^2
    std::string picture;       ///< name of the picture it shines with
    double mean_emission = 0;  ///< mean luminance over that picture, cd/m^2
    std::string road_table;    ///< name of its reflection table
    double area = 0;           ///< m^2, of all its triangles
};

struct SceneReport {
    glm::dvec3 extent{0};         ///< m, along world axes
    uint64_t triangles = 0;       ///< of all placements
    double area = 0;              ///< m^2
    double mean_reflectance = 0;  ///< diffuse, by area
    double lumens = 0;            ///< of all lamps
    std::vector<LampReport> lamps;
    std::vector<MaterialReport> materials;  ///< those that are seen
    std::vector<std::string> cameras;
    std::vector<std::string> warnings;  ///< what is implausible, one line each
};

/// At the poses of t = 0.
SceneReport report_scene(const Scene&);

const char* name_of(Lamp::Kind);
const char* name_of(FixtureRule);  ///< "own", "none", "named"

}  // namespace vesper::scene
