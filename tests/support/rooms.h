// Scenes of flat walls and bare lamps, built in code. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "scene/scene.h"

namespace vesper::test {

inline uint32_t add_material(scene::Scene& scene, float reflectance, float emission = 0) {
    scene::Material& material = scene.materials.emplace_back();
    material.base_colour = glm::vec4(glm::vec3(reflectance), 1), material.emission = glm::vec3(emission);
    return uint32_t(scene.materials.size() - 1);
}

/// A rectangle from a corner along two sides, seen from where these turn counter-clockwise; at a node of its own.
inline void add_rectangle(scene::Scene& scene, uint32_t material, glm::vec3 corner, glm::vec3 along, glm::vec3 up) {
    scene::Primitive& p = scene.meshes.emplace_back().primitives.emplace_back();
    p.material = material;
    for (const glm::vec3 at : {corner, corner + along, corner + along + up, corner + up}) {
        p.vertices.emplace_back().position = at;
        p.vertices.back().normal = glm::normalize(glm::cross(along, up));
        p.bounds.add(at);
    }
    p.indices = {0, 1, 2, 0, 2, 3};
    scene.nodes.emplace_back().mesh = uint32_t(scene.meshes.size() - 1);
}

/// A floor at y = 0, square about the origin.
inline void add_floor(scene::Scene& scene, uint32_t material, float half) {
    add_rectangle(scene, material, {-half, 0, -half}, {0, 0, 2 * half}, {2 * half, 0, 0});
}

/// The inside of a box; each wall at a node of its own.
inline void add_room(scene::Scene& scene, uint32_t material, glm::vec3 half, glm::vec3 middle = glm::vec3(0)) {
    const auto wall = [&](glm::vec3 corner, glm::vec3 along, glm::vec3 up) {
        add_rectangle(scene, material, middle + corner, along, up);
    };
    const glm::vec3 x(2 * half.x, 0, 0), y(0, 2 * half.y, 0), z(0, 0, 2 * half.z);
    wall(-half, z, x), wall({-half.x, half.y, -half.z}, x, z);
    wall(-half, x, y), wall({-half.x, -half.y, half.z}, y, x);
    wall(-half, y, z), wall({half.x, -half.y, -half.z}, z, y);
}

/// The same box from the outside.
inline void add_box(scene::Scene& scene, uint32_t material, glm::vec3 half, glm::vec3 middle) {
    const size_t first = scene.meshes.size();
    add_room(scene, material, half, middle);
    for (size_t i = first; i < scene.meshes.size(); ++i) {
        scene::Primitive& p = scene.meshes[i].primitives[0];
        p.indices = {0, 2, 1, 0, 3, 2};
        for (scene::Vertex& vertex : p.vertices) vertex.normal = -vertex.normal;
    }
}

/// Turns what has no transforms of its own about the y axis, and returns by what.
inline glm::dmat3 turn(scene::Scene& scene, double degrees) {
    const double c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
    const glm::dmat3 by(glm::dvec3(c, 0, -s), glm::dvec3(0, 1, 0), glm::dvec3(s, 0, c));
    for (scene::Mesh& mesh : scene.meshes)
        for (scene::Primitive& p : mesh.primitives) {
            p.bounds = {};
            for (scene::Vertex& vertex : p.vertices) {
                vertex.position = glm::vec3(by * glm::dvec3(vertex.position));
                vertex.normal = glm::vec3(by * glm::dvec3(vertex.normal));
                p.bounds.add(vertex.position);
            }
        }
    for (scene::Node& node : scene.nodes) node.translation = by * node.translation;
    return by;
}

/// The same candela in all directions; every mesh hides it.
inline void add_lamp(scene::Scene& scene, float candela, glm::dvec3 position) {
    scene::Lamp& lamp = scene.lamps.emplace_back();
    lamp.intensity = candela;
    scene::Node& node = scene.nodes.emplace_back();
    node.lamp = uint32_t(scene.lamps.size() - 1), node.translation = position;
    node.fixture = scene::kNone;
}

/// A closed room with a lamp and a panel that emits.
inline scene::Scene lit_room() {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.5f), glm::vec3(2));
    add_lamp(scene, 100, {0, 0, 0});
    add_rectangle(scene, add_material(scene, 0, 10), {-1, 1, 1}, {2, 0, 0}, {0, 0, -2});
    return scene;
}

}  // namespace vesper::test
