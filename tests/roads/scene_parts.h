// What scenes of roads are made of, for tests. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace vesper::test {
struct Triangle {
    std::array<glm::dvec3, 3> corners;
    std::array<glm::dvec3, 3> normals;
    glm::dvec3 across() const { return glm::cross(corners[1] - corners[0], corners[2] - corners[0]); }
};

/// All triangles of a material, by its name; of all materials where that is empty.
inline std::vector<Triangle> triangles_of(const scene::Scene& scene, const std::string& material) {
    std::vector<Triangle> found;
    for (const scene::Node& node : scene.nodes) {
        if (node.mesh == scene::kNone) continue;
        for (const scene::Primitive& primitive : scene.meshes[node.mesh].primitives) {
            if (!material.empty() && scene.materials[primitive.material].name != material) continue;
            for (size_t i = 0; i < primitive.indices.size(); i += 3) {
                Triangle triangle;
                for (size_t c = 0; c < 3; ++c) {
                    const scene::Vertex& vertex = primitive.vertices.at(primitive.indices[i + c]);
                    triangle.corners[c] = vertex.position, triangle.normals[c] = vertex.normal;
                }
                found.push_back(triangle);
            }
        }
    }
    return found;
}

inline double area_of(const std::vector<Triangle>& triangles) {
    double sum = 0;
    for (const Triangle& triangle : triangles) sum += glm::length(triangle.across()) / 2;
    return sum;
}

inline std::vector<scene::Node> lamps_of(const scene::Scene& scene, const std::string& prefix) {
    std::vector<scene::Node> found;
    for (const scene::Node& node : scene.nodes)
        if (node.lamp != scene::kNone && node.name.starts_with(prefix)) found.push_back(node);
    return found;
}

}  // namespace vesper::test
