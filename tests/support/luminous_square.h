// A square that shines, before an eye. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "scene/scene_files.h"
#include "support/program.h"

namespace vesper::test {

/// Adds a square with these corners, m, that emits so many cd/m^2 and reflects nothing.
inline void add_luminous_square(GltfFile& file, const std::string& name, const std::vector<float>& corners,
                                double luminance) {
    const auto material = file.root["materials"].size();
    file.root["materials"].push_back(
        {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}}},
         {"emissiveFactor", {1, 1, 1}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", luminance}}}}}});
    file.root["extensionsUsed"] = {"KHR_materials_emissive_strength"};
    file.show({{"attributes", {{"POSITION", file.vec3(corners)}}},
               {"indices", file.indices(std::vector<uint16_t>{0, 1, 2, 0, 2, 3})},
               {"material", material}},
              {{"name", name}});
}

/// Adds the camera "eye" in the origin, 1 rad high, which looks along -z.
inline void add_eye(GltfFile& file) {
    file.root["nodes"].push_back({{"name", "eye"}, {"camera", 0}});
    file.root["cameras"] = {
        {{"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
}

/// A glTF file of one square of 100 cd/m^2 with these corners, x, y, z of each, m, counterclockwise; seen by the camera
/// "eye" in the origin, 1 rad high.
inline std::string luminous_square(std::initializer_list<float> corners) {
    GltfFile file;
    add_luminous_square(file, "square", corners, 100);
    add_eye(file);
    return file.text();
}

}  // namespace vesper::test
