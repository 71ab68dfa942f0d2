// Scenes of plates and boxes with lamps, to cast shadows in. SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <random>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace vesper::test {

/// A scene that grows by one node at a time. Nodes have no parents.
class OccluderScene {
public:
    OccluderScene() { scene_.materials.emplace_back().double_sided = true; }

    /// A rectangle with these half sides about a point, as a node of its own. Returns the node.
    uint32_t plate(glm::vec3 middle, glm::vec3 half_u, glm::vec3 half_v) {
        begin_mesh();
        add_plate(middle, half_u, half_v);
        return end_mesh();
    }
    /// An axis-aligned box.
    uint32_t box(glm::vec3 middle, glm::vec3 half) {
        begin_mesh();
        for (int axis = 0; axis < 3; ++axis)
            for (const float side : {-1.0f, 1.0f}) {
                glm::vec3 out(0), u(0), v(0);
                out[axis] = side * half[axis];
                u[(axis + 1) % 3] = half[(axis + 1) % 3], v[(axis + 2) % 3] = side * half[(axis + 2) % 3];
                add_plate(middle + out, u, v);
            }
        return end_mesh();
    }
    /// A lamp at a node of its own that shines along -z of `rotation`.
    uint32_t lamp(const scene::Lamp& lamp, glm::dvec3 place, glm::quat rotation = {1, 0, 0, 0}) {
        scene::Node& node = scene_.nodes.emplace_back();
        node.translation = place, node.rotation = rotation, node.lamp = uint32_t(scene_.lamps.size());
        scene_.lamps.push_back(lamp);
        return uint32_t(scene_.nodes.size() - 1);
    }

    scene::Scene& scene() { return scene_; }

private:
    void begin_mesh() { scene_.meshes.emplace_back().primitives.emplace_back(); }
    void add_plate(glm::vec3 middle, glm::vec3 u, glm::vec3 v) {
        scene::Primitive& p = scene_.meshes.back().primitives.back();
        const uint32_t first = uint32_t(p.vertices.size());
        for (const glm::vec2 at : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
            scene::Vertex& vertex = p.vertices.emplace_back();
            vertex.position = middle + at.x * u + at.y * v;
            vertex.normal = glm::normalize(glm::cross(u, v));
            vertex.uv = 0.5f * at + 0.5f;
            p.bounds.add(vertex.position);
        }
        for (const uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(first + k);
    }
    uint32_t end_mesh() {
        scene_.nodes.emplace_back().mesh = uint32_t(scene_.meshes.size() - 1);
        return uint32_t(scene_.nodes.size() - 1);
    }

    scene::Scene scene_;
};

/// Leaves all around, 4 m away: plates with holes in their texture, of vertices that are from clear to opaque, and of a
/// material that is not quite opaque.
inline OccluderScene leaves() {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    OccluderScene s;
    const auto vector = [&] {
        const float x = unit(random), y = unit(random), z = unit(random);
        return glm::vec3(x, y, z);
    };
    for (int i = 0; i < 60; ++i) {  // wide enough that no map has two texels of a leaf in one of its own
        const glm::vec3 middle = 4.0f * glm::normalize(vector()), facing = glm::normalize(middle + vector()),
                        along = glm::normalize(glm::cross(facing, vector()));
        const float length = 0.8f + 0.3f * unit(random), width = 0.8f + 0.3f * unit(random);
        s.plate(middle, length * along, width * glm::cross(facing, along));
    }
    s.scene().images = {{"hole", 2, 2, {255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 255, 255, 255, 255, 255}}};
    scene::Material& m = s.scene().materials[0];
    m.alpha = scene::Material::Alpha::Mask, m.base_colour.a = 0.8f, m.alpha_cutoff = 0.5f;
    m.base_colour_texture = {.image = 0, .wrap_u = scene::Wrap::Clamp, .wrap_v = scene::Wrap::Clamp, .nearest = true};
    for (scene::Mesh& mesh : s.scene().meshes)
        for (scene::Vertex& vertex : mesh.primitives[0].vertices)
            vertex.colour[3] = uint16_t(random() % 2 ? 65535 : 16000);
    return s;
}

/// Another material, without holes. Returns its number.
inline uint32_t opaque(OccluderScene& s) {
    s.scene().materials.emplace_back().double_sided = true;
    return uint32_t(s.scene().materials.size() - 1);
}

}  // namespace vesper::test
