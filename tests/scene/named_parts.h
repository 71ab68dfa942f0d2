// A scene of named parts, for tests of photometry templates. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "scene/apply_photometry.h"
#include "scene/photometry_template.h"
#include "scene/scene_files.h"

namespace vesper::test {

/// A scene in the making, m.
struct NamedParts {
    scene::Scene scene;

    uint32_t node(const std::string& name, uint32_t parent = scene::kNone, glm::dvec3 at = glm::dvec3(0)) {
        scene.nodes.push_back({.name = name, .parent = parent, .translation = at});
        return uint32_t(scene.nodes.size() - 1);
    }
    uint32_t material(const std::string& name, glm::vec3 colour = glm::vec3(0.3f)) {
        scene.materials.push_back({.name = name, .base_colour = glm::vec4(colour, 1)});
        return uint32_t(scene.materials.size() - 1);
    }
    /// A rectangle from one corner to the opposite one, in the plane of the two directions that differ.
    void show(uint32_t node, uint32_t material, glm::vec3 a, glm::vec3 along, glm::vec3 across) {
        scene::Primitive p{.material = material};
        for (const glm::vec3 at : {a, a + along, a + along + across, a + across}) {
            p.vertices.push_back({.position = at, .normal = glm::normalize(glm::cross(along, across))});
            p.bounds.add(at);
        }
        p.indices = {0, 1, 2, 0, 2, 3};
        uint32_t& mesh = scene.nodes[node].mesh;
        if (mesh == scene::kNone) mesh = uint32_t(scene.meshes.size()), scene.meshes.emplace_back();
        scene.meshes[mesh].primitives.push_back(p);
    }
    void light(uint32_t node, scene::Lamp::Kind kind, float intensity) {
        scene.nodes[node].lamp = uint32_t(scene.lamps.size());
        scene.lamps.push_back({.kind = kind, .intensity = intensity});
    }
    scene::PhotometryTemplate made() const { return scene::make_photometry_template(scene, "s.gltf"); }
    nlohmann::json rules(const char* key) const { return nlohmann::json::parse(made().text).at(key); }

    /// Warnings of applying the template.
    std::vector<std::string> warnings() const {
        const TempFolder folder;
        scene::Scene lit = scene;
        return scene::apply_photometry(lit, scene::read_photometry(folder.write("p.json", made().text)), "s.gltf")
            .warnings;
    }
    void expect_clean() const {
        for (const std::string& warning : warnings()) ADD_FAILURE() << warning;
    }
};

}  // namespace vesper::test
