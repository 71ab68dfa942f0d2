// The triangles that have cells, in the world. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "rays/triangles.h"
#include "scene/scene.h"

namespace vesper::transport {

/// Of a triangle, in the world; m.
struct Corners {
    std::array<glm::dvec3, 3> points, normals;
    double area;

    glm::dvec3 at(glm::dvec3 weights) const {
        return weights.x * points[0] + weights.y * points[1] + weights.z * points[2];
    }
    double side(int from) const { return glm::distance(points[size_t(from)], points[size_t((from + 1) % 3)]); }
    int longest() const {  // the side, by where it begins
        int longest = 0;
        for (int k = 1; k < 3; ++k)
            if (side(k) > side(longest)) longest = k;
        return longest;
    }
};

/// A primitive of a node.
struct PlacedPrimitive {
    const scene::Primitive& primitive;
    uint32_t node, number;
    bool double_sided;
    const glm::dmat4& world;
    glm::dmat3 turn;  // of normals

    uint32_t triangles() const { return uint32_t(primitive.indices.size() / 3); }
    // None of what rays do not meet either.
    std::optional<Corners> corners(uint32_t triangle) const {
        Corners c{};
        double farthest = 0;  // per axis, as rays/ has it
        for (size_t k = 0; k < 3; ++k) {
            const scene::Vertex& vertex = primitive.vertices[primitive.indices[3 * size_t(triangle) + k]];
            c.points[k] = glm::dvec3(world * glm::dvec4(vertex.position, 1));
            c.normals[k] = turn * glm::dvec3(vertex.normal);
            const glm::dvec3 a = glm::abs(c.points[k]);
            farthest = std::max({farthest, a.x, a.y, a.z});
        }
        c.area = 0.5 * glm::length(glm::cross(c.points[1] - c.points[0], c.points[2] - c.points[0]));
        if (!(c.area > 0 && farthest <= rays::kFarthest)) return std::nullopt;
        return c;
    }
};

/// All of a scene with its nodes at `world`, but for clear ones. They refer to both.
std::vector<PlacedPrimitive> primitives_of(const scene::Scene& scene, std::span<const glm::dmat4> world);

}  // namespace vesper::transport
