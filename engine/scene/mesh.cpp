#include "scene/mesh.h"

#include <cmath>

namespace vesper::scene {

glm::vec3 area_normal(const std::vector<Vertex>& vertices, const uint32_t* corners) {
    const glm::vec3 a = vertices[corners[0]].position;
    return glm::cross(vertices[corners[1]].position - a, vertices[corners[2]].position - a);
}

glm::vec3 unit_or_up(glm::vec3 v) {
    // In double: squares of small and of large coordinates leave the range of float.
    const glm::dvec3 d(v);
    const double length = glm::length(d);
    return length > 0 && std::isfinite(length) ? glm::vec3(d / length) : glm::vec3(0, 1, 0);
}

void fill_normals(Primitive& primitive, const std::vector<char>& missing) {
    for (size_t i = 0; i < missing.size(); ++i)
        if (missing[i]) primitive.vertices[i].normal = glm::vec3(0);
    for (size_t i = 0; i < primitive.indices.size(); i += 3) {
        const glm::vec3 normal = area_normal(primitive.vertices, &primitive.indices[i]);
        for (size_t c = i; c < i + 3; ++c)
            if (missing[primitive.indices[c]]) primitive.vertices[primitive.indices[c]].normal += normal;
    }
    for (size_t i = 0; i < missing.size(); ++i)
        if (missing[i]) primitive.vertices[i].normal = unit_or_up(primitive.vertices[i].normal);
}

void make_flat(Primitive& primitive) {
    std::vector<Vertex> corners(primitive.indices.size());
    for (size_t i = 0; i < primitive.indices.size(); i += 3) {
        const glm::vec3 normal = unit_or_up(area_normal(primitive.vertices, &primitive.indices[i]));
        for (size_t c = i; c < i + 3; ++c) {
            corners[c] = primitive.vertices[primitive.indices[c]];
            corners[c].normal = normal;
            primitive.indices[c] = static_cast<uint32_t>(c);
        }
    }
    primitive.vertices = std::move(corners);
}

}  // namespace vesper::scene
