#include "rays/triangles.h"

#include <algorithm>

#include "scene/scene.h"

namespace vesper::rays {
namespace {

using scene::Primitive, scene::Scene;

/// Calls for each primitive of each node that can stop light: (node, index of the primitive, primitive).
template <class Call>
void for_each_primitive(const Scene& scene, const Call& call) {
    for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
        if (scene.nodes[node].mesh == scene::kNone) continue;
        const std::vector<Primitive>& primitives = scene.meshes[scene.nodes[node].mesh].primitives;
        for (uint32_t p = 0; p < primitives.size(); ++p)
            if (!scene.materials[primitives[p].material].clear) call(node, p, primitives[p]);
    }
}

/// A corner in the world, m.
glm::dvec3 corner_of(const Primitive& primitive, size_t index, const glm::dmat4& world) {
    return glm::dvec3(world * glm::dvec4(primitive.vertices[primitive.indices[index]].position, 1));
}

bool in_reach(glm::dvec3 v) {  // false for NaN
    return std::abs(v.x) <= kFarthest && std::abs(v.y) <= kFarthest && std::abs(v.z) <= kFarthest;
}

/// The median of some corners: unlike a mean it is among the triangles if a few of them are far away.
glm::dvec3 middle_of(const Scene& scene, std::span<const glm::dmat4> world, uint64_t count) {
    constexpr uint64_t kSamples = 4096;
    const uint64_t step = count / kSamples + 1;
    std::array<std::vector<double>, 3> samples;
    uint64_t number = 0, next = 0;
    for_each_primitive(scene, [&](uint32_t node, uint32_t, const Primitive& primitive) {
        const uint64_t end = number + primitive.indices.size() / 3;
        for (; next < end; next += step) {
            const glm::dvec3 corner = corner_of(primitive, size_t(next - number) * 3, world[node]);
            if (!in_reach(corner)) continue;
            for (int axis = 0; axis < 3; ++axis) samples[size_t(axis)].push_back(corner[axis]);
        }
        number = end;
    });
    glm::dvec3 middle(0);
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double>& values = samples[size_t(axis)];
        if (values.empty()) continue;
        const auto median = values.begin() + std::ptrdiff_t(values.size() / 2);
        std::nth_element(values.begin(), median, values.end());
        middle[axis] = *median;
    }
    return middle;
}

bool has_area(const Triangle& triangle) {
    const glm::dvec3 a(triangle.corners[0]), b(triangle.corners[1]), c(triangle.corners[2]);
    return glm::cross(b - a, c - a) != glm::dvec3(0);
}

/// Of the last run.
void add_triangles(TriangleList& list, const Primitive& primitive, const glm::dmat4& world) {
    for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        Triangle triangle{.corners = {}, .run = uint32_t(list.runs.size() - 1), .number = uint32_t(i / 3)};
        bool usable = true;
        for (size_t k = 0; k < 3; ++k) {
            const glm::dvec3 corner = corner_of(primitive, i + k, world);
            usable = usable && in_reach(corner);
            triangle.corners[k] = glm::vec3(corner - list.origin);
        }
        if (usable && has_area(triangle))
            list.triangles.push_back(triangle);
        else
            ++list.left_out;
    }
}

}  // namespace

uint64_t count_triangles(const Scene& scene) {
    uint64_t count = 0;
    for_each_primitive(scene, [&](uint32_t, uint32_t, const Primitive& p) { count += p.indices.size() / 3; });
    return count;
}

TriangleList list_triangles(const Scene& scene, std::span<const glm::dmat4> world) {
    const uint64_t count = count_triangles(scene);
    TriangleList list;
    list.origin = middle_of(scene, world, count);
    list.triangles.reserve(count);
    for_each_primitive(scene, [&](uint32_t node, uint32_t index, const Primitive& primitive) {
        const bool masked = scene.materials[primitive.material].alpha == scene::Material::Alpha::Mask;
        list.runs.push_back({node, index, masked});
        add_triangles(list, primitive, world[node]);
    });
    return list;
}

}  // namespace vesper::rays
