#include "scene/fixtures.h"

#include <algorithm>
#include <cmath>

namespace vesper::scene {
namespace {

constexpr double kFarthestAside = 20, kFarthestUp = 50;  // m, from the lamp: the ends of long arms and of high masts
constexpr double kHousing = 0.75;                        // m

bool is_near(const Scene& scene, uint32_t node, const glm::dmat4& world, glm::dvec3 place) {
    return std::ranges::all_of(scene.meshes[scene.nodes[node].mesh].primitives, [&](const Primitive& primitive) {
        if (primitive.bounds.empty()) return true;
        for (const glm::dvec3 corner : placed_corners(primitive.bounds, world)) {
            const glm::dvec3 from = corner - place;
            if (std::hypot(from.x, from.z) >= kFarthestAside || std::abs(from.y) >= kFarthestUp) return false;
        }
        return true;
    });
}

}  // namespace

std::vector<uint32_t> nodes_with_lamps(const Scene& scene) {
    std::vector<uint32_t> nodes;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].lamp != kNone) nodes.push_back(i);
    return nodes;
}

std::vector<bool> nodes_above_meshes(const Scene& scene) {
    std::vector<bool> has_mesh(scene.nodes.size());
    for (size_t i = scene.nodes.size(); i-- > 0;) {  // children come after their parents
        has_mesh[i] = has_mesh[i] || scene.nodes[i].mesh != kNone;
        if (has_mesh[i] && scene.nodes[i].parent != kNone) has_mesh[scene.nodes[i].parent] = true;
    }
    return has_mesh;
}

std::vector<std::vector<uint32_t>> fixture_nodes(const Scene& scene, std::span<const uint32_t> lamp_nodes,
                                                 std::span<const glm::dmat4> world) {
    const std::vector<bool> has_mesh = nodes_above_meshes(scene);
    const auto root_of = [&](uint32_t node) {
        if (scene.nodes[node].fixture) return *scene.nodes[node].fixture;
        while (node != kNone && !has_mesh[node]) node = scene.nodes[node].parent;
        return node;
    };
    std::vector<bool> is_root(scene.nodes.size());
    for (const uint32_t lamp : lamp_nodes)
        if (const uint32_t root = root_of(lamp); root != kNone) is_root[root] = true;
    std::vector<std::vector<uint32_t>> by_root(scene.nodes.size());
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        for (uint32_t node = i; scene.nodes[i].mesh != kNone && node != kNone; node = scene.nodes[node].parent)
            if (is_root[node]) by_root[node].push_back(i);
    std::vector<std::vector<uint32_t>> own;
    for (const uint32_t lamp : lamp_nodes) {
        own.emplace_back();
        const uint32_t root = root_of(lamp);
        if (root == kNone) continue;
        const glm::dvec3 place(world[lamp][3]);
        if (scene.nodes[lamp].fixture ||
            std::ranges::all_of(by_root[root], [&](uint32_t i) { return is_near(scene, i, world[i], place); }))
            own.back() = by_root[root];
    }
    return own;
}

double housing_reach(const Node& lamp) { return lamp.fixture ? HUGE_VAL : kHousing; }

}  // namespace vesper::scene
