// A card before a wall, both of their own light. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "support/program.h"

namespace vesper::test {

/// A glTF file: a card of 2 m by 3 m and 3 cd/m^2, `away` m before the camera "eye" in the origin (1 rad high), and
/// 10 m behind it a wall of 2 cd/m^2.
inline std::string luminous_card(float away) {
    GltfFile file;
    const auto add = [&](const char* name, double light, float left, float low, float width, float height, float z) {
        const auto material = file.root["materials"].size();
        file.root["materials"].push_back(
            {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}}},
             {"emissiveFactor", {1, 1, 1}},
             {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", light}}}}}});
        const float right = left + width, high = low + height;
        file.show(
            {{"attributes", {{"POSITION", file.vec3({left, low, z, right, low, z, right, high, z, left, high, z})}}},
             {"indices", file.indices(std::vector<uint16_t>{0, 1, 2, 0, 2, 3})},
             {"material", material}},
            {{"name", name}});
    };
    add("wall", 2, -100, -100, 200, 200, -away - 10);
    add("card", 3, -1, -1.2f, 2, 3, -away);
    file.root["nodes"].push_back({{"name", "eye"}, {"camera", 0}});
    file.root["cameras"] = {
        {{"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
    file.root["extensionsUsed"] = {"KHR_materials_emissive_strength"};
    return file.text();
}

}  // namespace vesper::test
